#include "ingest/axes/space_axis.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "format/base/ascii.h"

namespace weir {
namespace {

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

template <std::size_t N>
bool begins_with(const std::array<std::string_view, N>& words, std::string_view name) {
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) { return name.starts_with(word); });
}

bool names_y_axis(const std::string& label) {
  constexpr std::array<std::string_view, 10> kNames{"y",  "yh",   "yf",   "yc",       "ny",
                                                    "nj", "rlat", "nlat", "northing", "row"};
  constexpr std::array<std::string_view, 3> kBegin{"lat", "south_north", "y_"};
  const std::string name = lower_case(label);
  return is_one_of(kNames, name) || begins_with(kBegin, name);
}

bool names_z_axis(const std::string& label) {
  constexpr std::array<std::string_view, 10> kNames{"z",  "zh",  "zf",   "zc",       "nz",
                                                    "nk", "alt", "plev", "pressure", "sigma"};
  constexpr std::array<std::string_view, 7> kBegin{"bottom_top", "lev", "depth", "height", "layer", "altitude", "z_"};
  const std::string name = lower_case(label);
  return is_one_of(kNames, name) || begins_with(kBegin, name);
}

}  // namespace

bool names_x_axis(const std::string& label) {
  constexpr std::array<std::string_view, 12> kNames{"x",    "xh", "xf",   "xc",      "xi",  "nx",
                                                    "rlon", "ni", "nlon", "easting", "col", "column"};
  constexpr std::array<std::string_view, 4> kBegin{"lon", "west_east", "x_", "xi_"};
  const std::string name = lower_case(label);
  return is_one_of(kNames, name) || begins_with(kBegin, name);
}

std::optional<std::size_t> space_direction(const std::string& label) {
  if (names_x_axis(label)) return 0;
  if (names_y_axis(label)) return 1;
  if (names_z_axis(label)) return 2;
  return std::nullopt;
}

bool names_space_axis(const std::string& label) {
  // The direction of these depends on the field of science.
  constexpr std::array<std::string_view, 3> kNames{"j", "k", "eta"};
  constexpr std::array<std::string_view, 1> kBegin{"eta_"};
  const std::string name = lower_case(label);
  return space_direction(label) || is_one_of(kNames, name) || begins_with(kBegin, name);
}

bool is_down(std::string_view positive) { return lower_case(positive) == "down"; }

bool is_space_axis(const AxisPlace& axis) {
  return names_space_axis(axis.label) || (axis.has_coordinates && !axis.units.empty() && !axis.is_time);
}

}  // namespace weir
