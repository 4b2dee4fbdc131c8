// Which of the numbers of a vector or tensor become the volume.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace weir {

/// More numbers than this along an axis are no components.
inline constexpr std::int64_t kMostComponents = 64;

struct ComponentChoice {
  bool magnitude = false;     ///< the square root of the sum of all squares
  std::int64_t position = 0;  ///< else the component with this position, from 0 on

  bool operator==(const ComponentChoice&) const = default;
};

/// "2", "magnitude"; "x", "y", "z" are 0, 1, 2. nullopt for anything else, and from kMostComponents on.
std::optional<ComponentChoice> parse_component(std::string_view text);
/// "2" or "magnitude".
std::string component_text(const ComponentChoice& choice);

/// The numbers of each voxel, which lie beside each other, and the choice among them.
struct VoxelComponents {
  std::int64_t count = 1;
  ComponentChoice choice;
};

}  // namespace weir
