#include "ingest/axes/axis_unit.h"

#include <algorithm>
#include <array>
#include <span>
#include <string>

#include "format/base/ascii.h"

namespace weir {
namespace {

constexpr auto kPrefixes =
    std::to_array<std::string_view>({"", "atto", "femto", "pico", "nano", "micro", "milli", "centi", "deci", "deca",
                                     "hecto", "kilo", "mega", "giga", "tera"});

// All names here are in lower case. A prefix and a final s may be added to these.
constexpr auto kTimeNames = std::to_array<std::string_view>({"second", "sec", "year", "annum"});
constexpr auto kSpaceNames =
    std::to_array<std::string_view>({"meter", "metre", "parsec", "radian", "pascal", "bar", "micron"});

constexpr auto kTimeSymbols = std::to_array<std::string_view>(
    {"s",     "ms",   "msec", "us",   "usec", "\u00b5s", "\u03bcs", "ns",    "nsec",   "ps",       "psec",
     "fs",    "fsec", "as",   "min",  "mins", "minute",  "minutes", "h",     "hr",     "hrs",      "hour",
     "hours", "d",    "day",  "days", "wk",   "week",    "weeks",   "month", "months", "yr",       "yrs",
     "kyr",   "kyrs", "myr",  "myrs", "gyr",  "gyrs",    "ka",      "ma",    "ga",     "code_time"});

constexpr auto kSpaceLetters =
    std::to_array<std::string_view>({"m", "A", "K"});  // K: for levels of potential temperature
constexpr auto kSpaceSymbols = std::to_array<std::string_view>(
    {"hm",     "dam",  "dm",          "cm",    "mm",     "um",      "\u00b5m",    "\u03bcm",    "nm",
     "pm",     "fm",   "km",          "pc",    "kpc",    "mpc",     "gpc",        "kpc/h",      "mpc/h",
     "au",     "ly",   "lightyear",   "foot",  "feet",   "ft",      "inch",       "inches",     "yd",
     "mi",     "mile", "miles",       "nmi",   "fathom", "fathoms", "angstrom",   "angstroms",  "\u00c5",
     "\u212b", "gpm",  "code_length", "pixel", "pixels", "px",      "voxel",      "voxels",     "deg",
     "\u00b0", "rad",  "mrad",        "urad",  "arcsec", "arcmin",  "arcseconds", "arcminutes", "pa",
     "hpa",    "kpa",  "mb",          "mbar",  "dbar",   "atm",     "torr",       "psi"});
/// Beginnings of units, as of degrees_north, sigma_level, "model level".
constexpr auto kSpaceBegin =
    std::to_array<std::string_view>({"degree", "level", "layer", "sigma", "model_level", "model level"});

bool has_word(std::span<const std::string_view> words, std::string_view unit) {
  return std::ranges::find(words, unit) != words.end();
}

// Returns whether `unit` is a prefix followed by one of `names`, in the singular or plural.
bool is_made_of(std::span<const std::string_view> names, std::string_view unit) {
  if (unit.ends_with('s')) unit.remove_suffix(1);
  return std::ranges::any_of(names, [&](std::string_view name) {
    return unit.ends_with(name) && has_word(kPrefixes, unit.substr(0, unit.size() - name.size()));
  });
}

}  // namespace

bool is_unit_of_time(std::string_view unit) {
  const std::string name = lower_case(trimmed(unit));
  return has_word(kTimeSymbols, name) || is_made_of(kTimeNames, name);
}

bool is_unit_of_space(std::string_view unit) {
  const std::string_view written = trimmed(unit);
  if (written.size() == 1) return has_word(kSpaceLetters, written);
  const std::string name = lower_case(written);
  const auto begins = [&](std::string_view word) { return name.starts_with(word); };
  return has_word(kSpaceSymbols, name) || is_made_of(kSpaceNames, name) || std::ranges::any_of(kSpaceBegin, begins);
}

}  // namespace weir
