// Which axis is a time: never one of a volume's three.
#pragma once

#include <string>

namespace weir {

/// What a file says of one axis; empty where it says nothing.
struct AxisWords {
  std::string name;           ///< of the dimension
  std::string units;          ///< of its coordinates, as the attributes of CF
  std::string axis;           ///< CF's attribute
  std::string standard_name;  ///< CF's attribute
  bool grows = false;         ///< the slowest axis of a NetCDF variable, and the only unlimited one
  std::string positive{};     ///< CF's attribute
};

/// By the conventions of CF (4.4): axis T, a standard name of a time, units "... since ..."; by the name time, unless
/// the units are of a length, an angle, a pressure or a level; by units of time where the name is t or begins with
/// time; and a dimension that grows, in units of time or in none (a number of steps is none), where it has no other
/// standard name and its own name is none of space. Axis X, Y or Z, or `positive`, outweighs all of these but the
/// standard name. Units of time alone are none: a seismic volume's depth is a travel time.
bool is_time_axis(const AxisWords& words);

}  // namespace weir
