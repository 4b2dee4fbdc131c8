// The grid of a VTK image, and how its points and cells become voxels.
#pragma once

#include <array>
#include <string>

#include "format/base/index.h"
#include "ingest/source/dataset_info.h"
#include "ingest/source/volume_source.h"
#include "ingest/values/axis_placement.h"

namespace weir {

/// world = origin + direction * (spacing * index), index counting points.
struct VtkImage {
  Index3 first;                                                ///< index of the lowest point
  Index3 points{1, 1, 1};                                      ///< along each axis
  Vector3 origin{0, 0, 0};                                     ///< world position of index 0, which `first` need not be
  Vector3 spacing{1, 1, 1};                                    ///< world units from point to point
  std::array<double, 9> direction{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row-major; column a is the direction of axis a
};

/// Returns the values per axis: points, or the cells between them (one cell on an axis with one point).
Index3 vtk_extent(const VtkImage& image, bool cells);

/// Sets extent, index_origin, spacing and origin. A cell's value lies in its middle: half a step from its lowest
/// point along each axis of several points. Throws Error(input), beginning with `info.path`, if a number is not
/// finite or a spacing is 0.
void place_vtk_image(const VtkImage& image, bool cells, SourceInfo& info);
/// Describes the extent and position as attributes of a listing.
void describe_vtk_image(const VtkImage& image, bool cells, const std::string& path, DatasetInfo& info);

}  // namespace weir
