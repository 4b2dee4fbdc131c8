#include "ingest/axes/time_axis.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "format/base/ascii.h"

namespace weir {
namespace {

// UDUNITS' names of times that outputs have.
constexpr std::array<std::string_view, 25> kUnits{
    "s",       "sec", "secs", "second", "seconds", "ms",    "us", "ns",  "ps",   "fs",     "min",   "mins", "minute",
    "minutes", "h",   "hr",   "hrs",    "hour",    "hours", "d",  "day", "days", "months", "years", "year"};

bool is_unit_of_time(std::string_view units) { return std::find(kUnits.begin(), kUnits.end(), units) != kUnits.end(); }

}  // namespace

bool is_time_axis(const AxisWords& words) {
  const std::string axis = lower_case(words.axis);
  const std::string units = lower_case(words.units);
  const std::string name = lower_case(words.name);
  if (axis == "t" || words.standard_name == "time") return true;
  if (axis == "x" || axis == "y" || axis == "z") return false;
  if (units.find(" since ") != std::string::npos) return true;
  if (name == "time" || name == "times") return units.empty() || is_unit_of_time(units);
  if (is_unit_of_time(units)) return name == "t" || name.starts_with("time") || words.grows;
  return words.grows && units.empty() && words.standard_name.empty();
}

}  // namespace weir
