#include "ingest/axes/time_axis.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "format/base/ascii.h"
#include "ingest/axes/axis_unit.h"
#include "ingest/axes/space_axis.h"

namespace weir {
namespace {

bool is_standard_time(std::string_view standard_name) {
  constexpr std::array<std::string_view, 3> kNames{"time", "forecast_period", "forecast_reference_time"};
  return std::ranges::find(kNames, standard_name) != kNames.end();
}

// Returns whether `units` is no real unit: a number of steps, or the code's own units.
bool is_no_unit(std::string_view units) {
  constexpr std::array<std::string_view, 13> kNone{"",          "1",          "-",         "none",  "count",
                                                   "index",     "step",       "steps",     "cycle", "cycles",
                                                   "iteration", "iterations", "code units"};
  return std::ranges::find(kNone, lower_case(trimmed(units))) != kNone.end();
}

}  // namespace

bool is_time_axis(const AxisWords& words) {
  const std::string axis = lower_case(words.axis);
  const std::string name = lower_case(words.name);
  if (axis == "t" || is_standard_time(words.standard_name)) return true;
  if (axis == "x" || axis == "y" || axis == "z" || !words.positive.empty()) return false;  // CF 4.3
  if (lower_case(words.units).find(" since ") != std::string::npos) return true;
  const bool grows = words.grows && words.standard_name.empty() && !names_space_axis(words.name);
  if (is_unit_of_time(words.units)) return name == "t" || name.starts_with("time") || grows;
  if (name == "time" || name == "times") return !is_unit_of_space(words.units);
  return grows && is_no_unit(words.units);
}

}  // namespace weir
