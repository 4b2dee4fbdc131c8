// Arrays and grids of vectors and tensors, with several numbers a voxel: --component chooses among them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ingest/headers/named_choice.h"
#include "ingest/source/component_choice.h"

namespace weir {

/// Returns why an array with `components` numbers a voxel cannot be converted; empty if it can.
std::string components_obstacle(std::int64_t components);

/// Returns the components that `choice` selects among the `components` numbers of each voxel. Throws Error(usage),
/// beginning with `where`, if a choice is needed and missing, or does not fit.
VoxelComponents choose_components(std::int64_t components, const std::optional<ComponentChoice>& choice,
                                  const std::string& where);

/// Returns the choices for choose_volume() from `arrays`, each with a name, an obstacle and a number of components.
/// If `wanted` is empty and some array of the requested kind can be converted, arrays of the other kind are no
/// choice: with --component the requested kind is vectors, without it scalars.
template <typename Array>
std::vector<NamedVolume> volumes_of_kind(const std::vector<Array>& arrays, const std::string& wanted,
                                         const std::optional<ComponentChoice>& choice) {
  const auto meant = [&](const Array& array) { return (array.components > 1) == choice.has_value(); };
  const bool by_kind = wanted.empty() && std::any_of(arrays.begin(), arrays.end(), [&](const Array& array) {
                         return array.obstacle.empty() && meant(array);
                       });
  std::vector<NamedVolume> choices;
  for (const Array& array : arrays) {
    const bool other = by_kind && array.obstacle.empty() && !meant(array);
    choices.push_back({array.name, other ? "it is of the other kind" : array.obstacle});
  }
  return choices;
}

}  // namespace weir
