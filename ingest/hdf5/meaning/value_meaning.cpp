#include "ingest/hdf5/meaning/value_meaning.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_attribute.h"
#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/meaning/openpmd.h"
#include "ingest/source/unit_text.h"
#include "ingest/source/unsigned_meaning.h"
#include "ingest/values/decode_values.h"
#include "ingest/values/value_notes.h"

namespace weir {
namespace {

// NC_FILL_SHORT ... of netcdf.h.
std::optional<StoredValue> netcdf_default_fill(ScalarType type) {
  switch (type) {
    case ScalarType::int16:
      return std::int64_t{-32767};
    case ScalarType::uint16:
      return std::uint64_t{65535};
    case ScalarType::int32:
      return std::int64_t{-2147483647};
    case ScalarType::uint32:
      return std::uint64_t{4294967295};
    case ScalarType::int64:
      return std::int64_t{-9223372036854775806};
    case ScalarType::uint64:
      return std::uint64_t{18446744073709551614U};
    case ScalarType::float32:
    case ScalarType::float64:
      return 9.9692099683868690e+36;
    default:
      return std::nullopt;
  }
}

// NetCDF libraries before 4.4.1 (2016) leave no mark on the file, but mark most variables that have dimensions.
bool is_netcdf(hid_t object) {
  for (const char* name : {"_Netcdf4Coordinates", "_Netcdf4Dimid"}) {
    if (has_attribute(object, name)) return true;
  }
  const Hdf5Handle root(H5Gopen2(object, "/", H5P_DEFAULT));
  return root && (has_attribute(root.get(), "_NCProperties") || has_attribute(root.get(), "_nc3_strict"));
}

// Only NetCDF chooses its floating-point fill numbers as fill values.
bool is_netcdfs_own(ScalarType type) { return type == ScalarType::float32 || type == ScalarType::float64; }

// Returns whether the stored value `fill` is `value`.
bool equals(std::span<const std::byte> fill, const StoredType& type, const StoredValue& value) {
  float read = 0;
  decode_values(fill, type.scalar, type.big_endian, {1, 0, {value}}, {&read, 1});
  return is_missing(read);
}

// Returns the attribute _Unsigned; empty if it is absent.
std::string unsigned_text(hid_t object) { return first_text_attribute(object, "_Unsigned"); }

// Returns the attribute as one finite number; `fallback` if the attribute is absent.
double packing(hid_t object, const char* name, double fallback, std::string& obstacle) {
  if (!has_attribute(object, name)) return fallback;
  const std::vector<StoredValue> values = stored_value_attribute(object, name);
  const double value = values.size() == 1 ? as_double(values[0]) : std::nan("");
  if (std::isfinite(value) && (value != 0.0 || fallback == 0.0)) return value;
  obstacle = cat("its attribute ", name, " is ", attribute_found(object, name), " and not one finite number",
                 fallback == 0.0 ? "" : " other than 0", ", so what its values mean is unknown; correct or remove it");
  return fallback;
}

// Returns why the attribute does not say clearly which numbers stand for missing data; empty if it does. `values` is
// the number of values that were read.
std::string missing_obstacle(hid_t object, const char* name, std::size_t values) {
  const std::size_t count = attribute_values(object, name);
  if (count > kMaxAttributeValues) {
    return cat("its attribute ", name, " has ", count, " values, and at most ", kMaxAttributeValues,
               " are read, so which voxels hold no data is unknown; shorten it");
  }
  if (count == values) return "";
  return cat("its attribute ", name, " is ", attribute_found(object, name), " and not ",
             count == 1 ? "a number" : "numbers", ", so which voxels hold no data is unknown; correct or remove it");
}

std::string unused_attribute(hid_t object) {
  for (const char* name : kValidAttributes) {
    if (has_attribute(object, name)) return not_applied_note(name);
  }
  return "";
}

}  // namespace

bool may_be_netcdf_fill(hid_t object, const StoredType& type, std::span<const std::byte> fill) {
  const auto by_netcdf = netcdf_default_fill(type.scalar);
  return is_netcdf(object) || (by_netcdf && equals(fill, type, *by_netcdf));
}

StoredType type_as_meant(hid_t object, StoredType type) {
  type.scalar = meant_type(unsigned_text(object), type.scalar);
  return type;
}

ValueMeaning value_meaning(hid_t object, const StoredType& type, std::span<const std::byte> fill) {
  ValueMeaning meaning;
  const bool meant_otherwise = !unsigned_text(object).empty();
  for (const char* name : {"_FillValue", "missing_value"}) {
    const std::vector<StoredValue> values = enumerated_value_attribute(object, name);
    std::string unheld;
    for (const StoredValue& value : values) {
      const StoredValue meant = meant_otherwise ? as_meant(value, type.scalar) : value;
      if (holds(type.scalar, meant)) meaning.mapping.missing.push_back(meant);
      if (unheld.empty()) unheld = unheld_note(name, meant, type.scalar);
    }
    add_note(unheld, meaning.note);
    const std::string obstacle = missing_obstacle(object, name, values.size());
    if (!obstacle.empty()) meaning.obstacle = obstacle;
  }
  // The default fill applies even if missing_value is set, because unwritten elements hold it.
  const auto by_netcdf = netcdf_default_fill(type.scalar);
  if (!has_attribute(object, "_FillValue") && by_netcdf && !fill.empty() && equals(fill, type, *by_netcdf) &&
      (is_netcdfs_own(type.scalar) || is_netcdf(object))) {
    std::vector<StoredValue>& missing = meaning.mapping.missing;
    if (std::ranges::find(missing, *by_netcdf) == missing.end()) missing.push_back(*by_netcdf);
  }
  std::string packed_unclearly;
  meaning.mapping.scale = packing(object, "scale_factor", 1.0, packed_unclearly);
  meaning.mapping.offset = packing(object, "add_offset", 0.0, packed_unclearly);
  meaning.unpacks = packed_unclearly.empty();
  if (!meaning.unpacks) meaning.obstacle = packed_unclearly;
  for (const char* name : {"units", "Units"}) {
    if (meaning.units.empty()) meaning.units = unit_text(first_text_attribute(object, name));
  }
  meaning.unit_si = openpmd_unit_si(object);
  add_note(unused_attribute(object), meaning.note);
  return meaning;
}

}  // namespace weir
