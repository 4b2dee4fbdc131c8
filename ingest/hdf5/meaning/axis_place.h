// One axis of an array: its name and where its elements lie.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace weir {

/// One axis: element i lies at origin + i * spacing.
struct AxisPlace {
  std::int64_t extent = 0;        ///< elements
  std::string label;              ///< empty where the file has no name for it
  std::optional<double> spacing;  ///< world units per element
  std::optional<double> origin;   ///< world position of element 0
  std::string note;               ///< why there is no spacing although there are coordinates; else empty
};

/// "Time=4 x bottom_top=14 x 48 x 48".
std::string axes_text(std::span<const AxisPlace> axes);

}  // namespace weir
