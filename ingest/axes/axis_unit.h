// Tells what the unit of an axis's coordinates measures.
#pragma once

#include <string_view>

namespace weir {

/// Returns whether `unit` is a plain unit of time: s, Minutes, milliseconds, Myr, code_time. Knows the names and
/// symbols of UDUNITS and of astronomy. "hours since 2000-01-01" is not a plain unit of time: it says a date.
bool is_unit_of_time(std::string_view unit);

/// Returns whether `unit` is a unit of a space axis: a length, an angle, a pressure or a level, by the names and
/// symbols of UDUNITS and of astronomy. Single letters are case-sensitive: m is a metre and A an angstrom; M and a
/// are neither.
bool is_unit_of_space(std::string_view unit);

}  // namespace weir
