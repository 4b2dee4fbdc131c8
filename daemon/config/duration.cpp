#include "daemon/config/duration.h"

#include <array>
#include <cmath>
#include <utility>

#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::array<std::pair<std::string_view, double>, 4> kDurationUnits{
    {{"s", 1}, {"min", 60}, {"h", 3600}, {"d", 86400}}};

}  // namespace

std::optional<double> parse_duration_s(std::string_view text) {
  double unit_s = 1;
  for (const auto& [name, seconds] : kDurationUnits) {
    if (!text.ends_with(name)) continue;
    unit_s = seconds;
    text.remove_suffix(name.size());
    break;
  }
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  const std::optional<double> number = parse_double(text);
  if (!number || !std::isfinite(*number) || *number < 0) return std::nullopt;
  return *number * unit_s;
}

}  // namespace weir
