// Arrays of VTK files that say which points or cells count and are no fields: ghost types, masks of valid points.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ingest/headers/named_choice.h"
#include "ingest/source/source_options.h"
#include "ingest/vectors/voxel_components.h"
#include "ingest/vtk/vtk_array.h"

namespace weir {

/// The reason why an array of marks is no volume unless --dataset names it.
inline constexpr const char* kMarkObstacle = "it marks points or cells, and is converted only where it is named";

/// Returns whether an array called `name` holds marks, by the names that VTK gives such arrays.
bool marks_places(std::string_view name);
inline bool marks_places(const VtkArray& array) { return marks_places(array.name); }

/// Returns the choices for choose_volume(), as volumes_of_kind() gives them. Arrays of marks are choices only if
/// options.dataset is given.
template <typename Array>
std::vector<NamedVolume> vtk_volumes(std::vector<Array> arrays, const SourceOptions& options) {
  for (Array& array : arrays) {
    if (!options.dataset.empty() || !array.obstacle.empty() || !marks_places(array)) continue;
    array.obstacle = kMarkObstacle;
  }
  return volumes_of_kind(arrays, options.dataset, options.component);
}

/// Returns a note that an array of `marks`, on the same points or cells as `field`, is not applied to `field`. Empty
/// if `field` itself holds marks, or if the file says that no point or cell is marked.
std::string marks_note(const VtkArray& field, const std::vector<VtkArray>& marks);

/// Returns marks_note() for `field`, one of `arrays`.
template <typename Array>
std::string marks_note_of(const Array& field, const std::vector<Array>& arrays) {
  return marks_note(field, std::vector<VtkArray>(arrays.begin(), arrays.end()));
}

}  // namespace weir
