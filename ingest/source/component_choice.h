// The choice of the number of a vector or tensor that becomes the volume.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace weir {

/// An axis of more elements than this does not hold components.
inline constexpr std::int64_t kMostComponents = 64;

struct ComponentChoice {
  bool magnitude = false;     ///< the square root of the sum of all squares
  std::int64_t position = 0;  ///< otherwise the position of the component, from 0

  bool operator==(const ComponentChoice&) const = default;
};

/// Parses "2" or "magnitude"; "x", "y", "z" are 0, 1, 2. Returns nullopt for any other text, and for positions from
/// kMostComponents on.
std::optional<ComponentChoice> parse_component(std::string_view text);
/// Returns "2" or "magnitude".
std::string component_text(const ComponentChoice& choice);

/// The numbers of each voxel, which lie side by side, and the choice among them.
struct VoxelComponents {
  std::int64_t count = 1;
  ComponentChoice choice;
};

}  // namespace weir
