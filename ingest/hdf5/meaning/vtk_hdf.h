// Where the arrays of VTK's own HDF5 files, .vtkhdf, lie, when they are, and which are no fields.
#pragma once

#include <span>

#include "ingest/axes/axis_place.h"
#include "ingest/axes/volume_time.h"
#include "ingest/hdf5/file/hdf5_object.h"

namespace weir {

/// Fills spacing and origin of the last three axes where `object` is an array of PointData or CellData in a group of
/// an image, which has WholeExtent, Origin, Spacing and perhaps Direction: "VTKHDF File Format", ImageData. The origin
/// is that of point (0, 0, 0), at which WholeExtent need not begin; a cell's value lies in its middle, half a spacing
/// from its lowest point along each axis of several points. The axis before them is a time where the image has Steps,
/// whose Values are its coordinates where they say one of each element: the array's offsets say which element a step
/// has, else it has that of its number. `groups` are those around the object. The caller holds Hdf5Lock. Throws
/// Error(input) where the times cannot be read.
void place_by_vtk_hdf(const Hdf5Object& object, std::span<const Hdf5Handle> groups, std::span<AxisPlace> axes);

/// The times of the image that `object` is an array of, without units, as VTK has them: Steps/Values, else TimeValue of
/// its FieldData. Empty where it is none, and where one is not finite. The caller holds Hdf5Lock. Throws Error(input)
/// where they cannot be read.
TimeValues vtk_hdf_time(const Hdf5Object& object, std::span<const Hdf5Handle> groups);

/// Whether `object` is an array of an image that says which points or cells count, and no field (vtk_marks.h). The
/// caller holds Hdf5Lock.
bool is_vtk_hdf_mark(const Hdf5Object& object, std::span<const Hdf5Handle> groups);

}  // namespace weir
