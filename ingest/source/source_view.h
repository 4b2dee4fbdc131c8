// Another source, seen differently: a region of interest of it, or the same
// voxels at another place in the world.
#pragma once

#include <memory>

#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// World units per voxel that a file can hold: it and its reciprocal stand there as float32, too.
inline constexpr double kLeastSpacing = 1e-37;
inline constexpr double kMostSpacing = 1e+37;

/// The voxels of `region` (index space, half open) of `source`, as a volume of its own. Indices stay
/// global: index_origin becomes region.lo, so every voxel keeps its index and world position.
/// Throws Error(usage), naming region and domain, where region is empty or reaches outside.
std::unique_ptr<VolumeSource> crop_source(std::unique_ptr<VolumeSource> source, const Box& region);

/// The same of the box that `region` means there. Throws Error(usage), too, where its ghost cells are all there is.
std::unique_ptr<VolumeSource> crop_to(std::unique_ptr<VolumeSource> source, const VolumeRegion& region);

/// `source` with options.spacing and options.origin in place of its own, where they are given. Throws
/// Error(usage) naming the option where a spacing is not finite and above 0 or an origin not finite, and
/// Error(input) where the file's own is such and no option replaces it.
std::unique_ptr<VolumeSource> place_source(std::unique_ptr<VolumeSource> source, const SourceOptions& options);

}  // namespace weir
