// Positions and times of the arrays in VTK's own HDF5 files (.vtkhdf), and which arrays are no fields.
#pragma once

#include <span>

#include "ingest/axes/axis_place.h"
#include "ingest/axes/volume_time.h"
#include "ingest/hdf5/file/hdf5_object.h"

namespace weir {

/// Fills spacing and origin of the last three axes if `object` is an array of PointData or CellData in an image's
/// group. The group has WholeExtent, Origin, Spacing and perhaps Direction ("VTKHDF File Format", ImageData). The
/// origin is the position of point (0, 0, 0); WholeExtent may begin elsewhere. A cell's value lies in its middle:
/// half a spacing from its lowest point along each axis of several points. If the image has Steps, the axis before
/// the three is a time. Its coordinates are the Steps' Values, if these give one for each element. The array's
/// offsets say which element a step has; without offsets, step n has element n. `groups` are the groups around the
/// object. The caller holds Hdf5Lock. Throws Error(input) if the times cannot be read.
void place_by_vtk_hdf(const Hdf5Object& object, std::span<const Hdf5Handle> groups, std::span<AxisPlace> axes);

/// Returns the times of the image that `object` belongs to, without units, as in VTK: Steps/Values, otherwise
/// TimeValue of its FieldData. Empty if `object` is no such array, or if a time is not finite. The caller holds
/// Hdf5Lock. Throws Error(input) if the times cannot be read.
TimeValues vtk_hdf_time(const Hdf5Object& object, std::span<const Hdf5Handle> groups);

/// Returns whether `object` is an image's array that says which points or cells count, and so is no field
/// (vtk_marks.h). The caller holds Hdf5Lock.
bool is_vtk_hdf_mark(const Hdf5Object& object, std::span<const Hdf5Handle> groups);

}  // namespace weir
