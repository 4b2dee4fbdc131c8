// Which axis is a time: never one of a volume's three.
#pragma once

#include <string>

namespace weir {

/// What a file says of one axis; empty where it says nothing.
struct AxisWords {
  std::string name;           ///< of the dimension
  std::string units;          ///< of its coordinates, as the next two
  std::string axis;           ///< CF's attribute
  std::string standard_name;  ///< CF's attribute
  bool grows = false;         ///< the slowest axis of a NetCDF variable, and the only unlimited one
};

/// By the conventions of CF (4.4): axis T, standard_name time, units "... since ..."; by the name time; by units of
/// time where the name is t or the dimension grows; and a dimension that grows where nothing says that it is a length.
/// Units of time alone are none: a seismic volume's depth is a travel time.
bool is_time_axis(const AxisWords& words);

}  // namespace weir
