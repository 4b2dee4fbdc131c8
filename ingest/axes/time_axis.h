// Recognises time axes. A time axis is never one of a volume's three.
#pragma once

#include <string>

namespace weir {

/// What a file says about one axis; empty strings if it says nothing.
struct AxisWords {
  std::string name;           ///< name of the dimension
  std::string units;          ///< units of its coordinates, an attribute of CF
  std::string axis;           ///< CF's attribute
  std::string standard_name;  ///< CF's attribute
  bool grows = false;         ///< it is the slowest axis of a NetCDF variable, and the only unlimited one
  std::string positive{};     ///< CF's attribute
};

/// Returns whether `words` describe a time, by the conventions of CF (4.4). Each of these is enough: axis T, a
/// standard name of a time, or units "... since ..."; the name time, unless the units are of a length, an angle, a
/// pressure or a level; units of time if the name is t or begins with time; a dimension that grows, with units of
/// time or none (a number of steps has none), if it has no other standard name and its name is not one of space. Axis
/// X, Y or Z, or `positive`, overrules all of these except axis T and the standard name. Units of time alone are not
/// enough: the depth axis of a seismic volume is a travel time.
bool is_time_axis(const AxisWords& words);

}  // namespace weir
