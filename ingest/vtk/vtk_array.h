// An array of a VTK image in any of VTK's file formats, and the volume that it becomes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "format/base/scalar_type.h"
#include "ingest/files/input_file.h"
#include "ingest/source/left_out.h"
#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"
#include "ingest/vectors/voxel_components.h"
#include "ingest/vtk/vtk_image.h"

namespace weir {

struct VtkArray {
  std::string name;  ///< "PointData/a" and "CellData/a" if points and cells have an array "a"
  bool cells = false;
  ScalarType type = ScalarType::float32;
  std::string type_name;                            ///< as written
  std::string obstacle;                             ///< why the array cannot be converted; empty if it can
  std::int64_t components = 1;                      ///< numbers a voxel, side by side
  std::optional<std::array<double, 2>> range = {};  ///< least and largest value, if the file says them
};

struct VtkVolume {
  SourceInfo info;
  VoxelComponents components;
  std::uint64_t bytes = 0;  ///< of all values, as they are stored without packing
  std::string where;        ///< what messages begin with
};

/// Returns the volume of `array` of `file` that `options` ask for. `array` has no obstacle. `format` is
/// SourceInfo::format. Throws Error if the image has no valid position, the requested components do not exist, or
/// there are too many values.
VtkVolume vtk_volume(const InputFile& file, const char* format, const VtkImage& image, const VtkArray& array,
                     const SourceOptions& options);

/// Reports to options.notice which of `arrays` cannot be converted, if options.dataset does not name `taken`.
template <typename Array>
void say_vtk_left_out(const std::string& path, const std::vector<Array>& arrays, const Array& taken,
                      const SourceOptions& options) {
  std::vector<LeftOut> left_out;
  for (const VtkArray& array : arrays) {
    if (!array.obstacle.empty()) left_out.push_back({array.name, array.obstacle});
  }
  if (!options.dataset.empty() || left_out.empty() || !options.notice) return;
  options.notice(left_out_notice(path, taken.name, left_out));
}

/// Returns "PointData/a" or "CellData/a".
std::string full_vtk_name(const std::string& name, bool cells);

/// Gives their full names to arrays with a name that occurs for both points and cells. Returns the short names.
template <typename Array>
std::set<std::string> tell_equal_names_apart(std::vector<Array>& arrays) {
  std::array<std::set<std::string>, 2> names;  // of points, of cells
  for (const VtkArray& array : arrays) names[array.cells ? 1 : 0].insert(array.name);
  std::set<std::string> of_both;
  std::ranges::set_intersection(names[0], names[1], std::inserter(of_both, of_both.end()));
  for (VtkArray& array : arrays) {
    if (of_both.contains(array.name)) array.name = full_vtk_name(array.name, array.cells);
  }
  return of_both;
}

}  // namespace weir
