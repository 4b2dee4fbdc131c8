// Arrays of VTK files that say which points or cells count, and are no fields: ghost types, masks of valid points.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ingest/headers/named_choice.h"
#include "ingest/source/source_options.h"
#include "ingest/vectors/voxel_components.h"
#include "ingest/vtk/vtk_array.h"

namespace weir {

/// Why such a one is no volume where --dataset names none.
inline constexpr const char* kMarkObstacle = "it marks points or cells, and is converted only where it is named";

/// Whether an array called so is such a one, by the names that VTK gives them.
bool marks_places(std::string_view name);
inline bool marks_places(const VtkArray& array) { return marks_places(array.name); }

/// What choose_volume chooses among, as volumes_of_kind says; arrays of marks only where options.dataset names one.
template <typename Array>
std::vector<NamedVolume> vtk_volumes(std::vector<Array> arrays, const SourceOptions& options) {
  for (Array& array : arrays) {
    if (!options.dataset.empty() || !array.obstacle.empty() || !marks_places(array)) continue;
    array.obstacle = kMarkObstacle;
  }
  return volumes_of_kind(arrays, options.dataset, options.component);
}

/// That an array of `marks`, of the same points or cells as `field`, is not applied to it; empty where `field` is of
/// marks itself, and where the file says that none is marked.
std::string marks_note(const VtkArray& field, const std::vector<VtkArray>& marks);

/// The note for `field`, one of `arrays`.
template <typename Array>
std::string marks_note_of(const Array& field, const std::vector<Array>& arrays) {
  return marks_note(field, std::vector<VtkArray>(arrays.begin(), arrays.end()));
}

}  // namespace weir
