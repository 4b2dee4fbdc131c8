// An array of a VTK image, whatever the format of the file, and the volume that it is.
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
  std::string name;  ///< "PointData/a" and "CellData/a" where points and cells have an array "a"
  bool cells = false;
  ScalarType type = ScalarType::float32;
  std::string type_name;                            ///< as written
  std::string obstacle;                             ///< why it cannot be converted; empty where it can
  std::int64_t components = 1;                      ///< numbers a voxel, side by side
  std::optional<std::array<double, 2>> range = {};  ///< least and largest value, where the file says them
};

struct VtkVolume {
  SourceInfo info;
  VoxelComponents components;
  std::uint64_t bytes = 0;  ///< of all values, as they are stored without packing
  std::string where;        ///< what messages begin with
};

/// `array` of `file`, which has no obstacle, as `options` ask for it. `format` is SourceInfo::format. Throws Error
/// where the image has no place, the components asked for are not there, or the values are too many.
VtkVolume vtk_volume(const InputFile& file, const char* format, const VtkImage& image, const VtkArray& array,
                     const SourceOptions& options);

/// Says to options.notice which of `arrays` cannot be converted, where `taken` is one that options.dataset does not
/// name.
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

/// "PointData/a" or "CellData/a".
std::string full_vtk_name(const std::string& name, bool cells);

/// Gives arrays that points and cells both have their full names. The names that these had.
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
