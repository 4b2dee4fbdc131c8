// Another source, seen differently: a region of interest of it, or the same
// voxels at another place in the world.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// World units per voxel that a file can hold: it and its reciprocal stand there as float32, too.
inline constexpr double kLeastSpacing = 1e-37;
inline constexpr double kMostSpacing = 1e+37;
/// And of an origin's coordinates, of either sign, in world units.
inline constexpr double kMostOrigin = 1e+37;

/// Why not all of `domain` has coordinates that float32 holds, with its voxels `spacing` apart; empty where it has.
std::string too_far_away(const Box& domain, const std::array<double, 3>& spacing, const std::array<double, 3>& origin);

/// The voxels of `region` (index space, half open) of `source`, as a volume of its own. Indices stay
/// global: index_origin becomes region.lo, so every voxel keeps its index and world position.
/// Throws Error(usage), naming region and domain, where region is empty or reaches outside.
std::unique_ptr<VolumeSource> crop_source(std::unique_ptr<VolumeSource> source, const Box& region);

/// The same of the box that `region` means there. Throws Error(usage), too, where its ghost cells are all there is.
std::unique_ptr<VolumeSource> crop_to(std::unique_ptr<VolumeSource> source, const VolumeRegion& region);

/// `source` with options.spacing and options.origin in place of its own, where they are given. Throws
/// Error(usage) naming the option where a spacing is not finite and above 0, an origin not finite, or either
/// places a voxel beyond what float32 holds, and Error(input) where the file's own is such and no option replaces it.
std::unique_ptr<VolumeSource> place_source(std::unique_ptr<VolumeSource> source, const SourceOptions& options);

}  // namespace weir
