#include "ingest/source/component_choice.h"

#include "format/base/text.h"

namespace weir {

std::optional<ComponentChoice> parse_component(std::string_view text) {
  if (text == "magnitude") return ComponentChoice{true, 0};
  constexpr std::string_view kNames = "xyz";
  if (text.size() == 1 && kNames.find(text) != std::string_view::npos) {
    return ComponentChoice{false, static_cast<std::int64_t>(kNames.find(text))};
  }
  const auto position = parse_int(text);
  if (!position || *position < 0 || *position >= kMostComponents) return std::nullopt;
  return ComponentChoice{false, *position};
}

std::string component_text(const ComponentChoice& choice) {
  return choice.magnitude ? "magnitude" : cat(choice.position);
}

}  // namespace weir
