// Where the arrays of VTK's own HDF5 files, .vtkhdf, lie.
#pragma once

#include <span>

#include "ingest/axes/axis_place.h"
#include "ingest/hdf5/file/hdf5_object.h"

namespace weir {

/// Fills spacing and origin of the last three axes where `object` is an array of PointData or CellData in a group of
/// an image, which has WholeExtent, Origin, Spacing and perhaps Direction: "VTKHDF File Format", ImageData. The origin
/// is that of point (0, 0, 0), at which WholeExtent need not begin; a cell's value lies in its middle, half a spacing
/// from its lowest point. `groups` are those around the object. The caller holds Hdf5Lock.
void place_by_vtk_hdf(const Hdf5Object& object, std::span<const Hdf5Handle> groups, std::span<AxisPlace> axes);

}  // namespace weir
