// Spacing and origin as plain attributes, as many programs write them.
#pragma once

#include <hdf5.h>

#include <span>

#include "ingest/axes/axis_place.h"
#include "ingest/hdf5/file/hdf5_handle.h"

namespace weir {

/// Fills spacing and origin of the last three axes, where they are not set and no note says that they are indices, from
/// the nearest of the dataset and the groups around it that has one of these attributes, of three values (or, of
/// spacing and voxel_size, one for all axes):
/// spacing, Spacing, SPACING, voxel_size, VoxelSize, voxelsize, origin, Origin, ORIGIN in the order x, y, z (x
/// fastest in memory), as VTK's HDF files have them;
/// element_size_um, resolution, offset in the order of the file's axes (slowest first), as ilastik and
/// CREMI write them: resolution of the dataset alone, and not where it is the extents, since simulations call the
/// number of cells so.
/// The caller holds Hdf5Lock.
void place_by_attributes(hid_t dataset, std::span<const Hdf5Handle> groups, std::span<AxisPlace> axes);

}  // namespace weir
