// What the unit of an axis's coordinates measures.
#pragma once

#include <string_view>

namespace weir {

/// Whether `unit` is one of time alone: s, Minutes, milliseconds, Myr, code_time. By UDUNITS' names and symbols, and
/// those of astronomy. "hours since 2000-01-01" is none: it says a date.
bool is_unit_of_time(std::string_view unit);

/// Whether `unit` is one that an axis of space has: of a length, an angle, a pressure or a level, by the same names.
/// One letter counts in its own case only: m is a metre and A an angstrom; M and a are neither.
bool is_unit_of_space(std::string_view unit);

}  // namespace weir
