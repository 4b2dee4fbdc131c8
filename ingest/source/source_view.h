// Views of another source: a region of interest of it, or the same voxels at another place in the world.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Limits of spacings that an output file can hold, in world units per voxel: the file has the spacing and its
/// reciprocal also as float32.
inline constexpr double kLeastSpacing = 1e-37;
inline constexpr double kMostSpacing = 1e+37;
/// Limit of the absolute value of an origin's coordinates, in world units.
inline constexpr double kMostOrigin = 1e+37;

/// Returns why some voxels of `domain`, which lie `spacing` apart, have coordinates that float32 cannot hold. Returns
/// an empty string if float32 holds all.
std::string too_far_away(const Box& domain, const std::array<double, 3>& spacing, const std::array<double, 3>& origin);

/// Returns the voxels of `region` (index space, half open) of `source` as a volume of its own. Indices stay global:
/// index_origin becomes region.lo, so every voxel keeps its index and world position. Throws Error(usage), naming
/// region and domain, if region is empty or reaches outside.
std::unique_ptr<VolumeSource> crop_source(std::unique_ptr<VolumeSource> source, const Box& region);

/// Crops `source` to the box that `region` means in its domain. Throws Error(usage) as crop_source does, and also if
/// the ghost cells leave no voxel.
std::unique_ptr<VolumeSource> crop_to(std::unique_ptr<VolumeSource> source, const VolumeRegion& region);

/// Returns `source` with its spacing and origin replaced by options.spacing and options.origin, if given. Throws
/// Error(usage) naming the option if a spacing is not finite and above 0, an origin is not finite, or either places a
/// voxel beyond what float32 holds. Throws Error(input) if the file's own spacing or origin is invalid in this way
/// and no option replaces it.
std::unique_ptr<VolumeSource> place_source(std::unique_ptr<VolumeSource> source, const SourceOptions& options);

}  // namespace weir
