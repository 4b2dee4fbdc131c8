#include "ingest/vdb/grid_class.h"

#include <cmath>

namespace weir {

GridClass grid_class_called(std::string_view name) {
  if (name == "level set") return GridClass::level_set;
  return name == "fog volume" ? GridClass::fog_volume : GridClass::unknown;
}

GridClass grid_class_stored(std::uint32_t number) {
  const auto stored = static_cast<GridClass>(number);
  return stored == GridClass::level_set || stored == GridClass::fog_volume ? stored : GridClass::unknown;
}

std::string_view grid_class_name(GridClass grid_class) {
  switch (grid_class) {
    case GridClass::level_set:
      return "level set";
    case GridClass::fog_volume:
      return "fog volume";
    case GridClass::unknown:
      break;
  }
  return {};
}

std::optional<float> background_to_keep(GridClass grid_class, double stored) {
  const auto value = static_cast<float>(stored);
  if (grid_class != GridClass::level_set || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace weir
