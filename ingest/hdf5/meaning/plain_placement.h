// Reads spacing and origin from plain attributes, which many programs write.
#pragma once

#include <hdf5.h>

#include <span>

#include "ingest/axes/axis_place.h"
#include "ingest/hdf5/file/hdf5_handle.h"

namespace weir {

/// Fills spacing and origin of the last three axes, if they are not set and no note says that they are indices. Takes
/// them from the nearest object, among the dataset and the groups around it, that has one of these attributes. An
/// attribute has three values; spacing and voxel_size may have one value for all axes.
/// spacing, Spacing, SPACING, voxel_size, VoxelSize, voxelsize, origin, Origin, ORIGIN are in the order x, y, z (x
/// fastest in memory), as in VTK's HDF files.
/// element_size_um, resolution, offset are in the order of the file's axes (slowest first), as ilastik and CREMI
/// write them. `resolution` counts only on the dataset itself, and not if it equals the extents, because simulations
/// use that name for the number of cells.
/// The caller holds Hdf5Lock.
void place_by_attributes(hid_t dataset, std::span<const Hdf5Handle> groups, std::span<AxisPlace> axes);

}  // namespace weir
