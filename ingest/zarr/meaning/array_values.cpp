#include "ingest/zarr/meaning/array_values.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "format/base/text.h"
#include "ingest/source/unit_text.h"
#include "ingest/source/unsigned_meaning.h"
#include "ingest/values/value_notes.h"
#include "ingest/zarr/codecs/library_codecs.h"
#include "ingest/zarr/meaning/zarr_nodes.h"
#include "ingest/zarr/metadata/fill_value.h"
#include "ingest/zarr/metadata/zarr_json.h"

namespace weir {
namespace {

constexpr std::size_t kMostMissing = 64;  // values in one attribute that stand for missing data

std::optional<StoredValue> number_of_attribute(const nlohmann::json& value) {
  if (const auto number = json_number(value)) return number;
  if (const auto packed = double_in_base64(value)) return StoredValue{*packed};
  if (value.is_boolean()) return StoredValue{std::int64_t{value.get<bool>() ? 1 : 0}};
  return value.is_string() ? parse_stored_value(value.get<std::string>()) : std::nullopt;
}

// Returns the attribute's number, or its list of numbers, the form of NetCDF's attributes. Other values go to
// `others`.
std::vector<StoredValue> numbers_of_attribute(const nlohmann::json& attributes, const char* name,
                                              std::vector<nlohmann::json>& others) {
  const nlohmann::json& value = json_member(attributes, name);
  std::vector<StoredValue> numbers;
  const auto add = [&](const nlohmann::json& one) {
    if (const auto number = number_of_attribute(one)) {
      numbers.push_back(*number);
    } else {
      others.push_back(one);
    }
  };
  if (!value.is_array() && !value.is_null()) add(value);
  for (std::size_t i = 0; value.is_array() && i < value.size(); ++i) add(value[i]);
  return numbers;
}

// Returns the attribute as one finite number; `fallback` if it is absent or, with an obstacle, if it is not such a
// number.
double packing(const nlohmann::json& attributes, const char* name, double fallback, std::string& obstacle) {
  const nlohmann::json& found = json_member(attributes, name);
  if (found.is_null()) return fallback;
  std::vector<nlohmann::json> others;
  const std::vector<StoredValue> values = numbers_of_attribute(attributes, name, others);
  const bool one = values.size() == 1 && others.empty();
  const double value = one ? as_double(values[0]) : std::nan("");
  if (std::isfinite(value) && (value != 0.0 || fallback == 0.0)) return value;
  obstacle = cat("its attribute ", name, " is ", json_text(found), " and not one finite number",
                 fallback == 0.0 ? "" : " other than 0", ", so what its values mean is unknown; correct or remove it");
  return fallback;
}

std::string not_numbers(const nlohmann::json& attributes, const char* name, const nlohmann::json& other) {
  const bool list = json_member(attributes, name).is_array();
  return cat("its attribute ", name, list ? " has " : " is ", json_text(other),
             list ? ", which is not a number" : " and not a number",
             ", so which voxels hold no data is unknown; correct or remove it");
}

std::string unused_attribute(const nlohmann::json& attributes) {
  for (const char* const name : kValidAttributes) {
    if (!json_member(attributes, name).is_null()) return not_applied_note(name);
  }
  return "";
}

// Reads the attributes by the CF conventions (8.1 and 2.5.1), as xarray writes them.
void read_attributes(const ZarrArray& array, ArrayValues& read) {
  const nlohmann::json& attributes = array.attributes;
  const bool meant_otherwise = !unsigned_text(attributes).empty();
  read.mapping.scale = packing(attributes, "scale_factor", 1.0, read.obstacle);
  read.mapping.offset = packing(attributes, "add_offset", 0.0, read.obstacle);
  const auto add_missing = [&](const StoredValue& stored, const char* name) {
    const StoredValue value = meant_otherwise ? as_meant(stored, array.type) : stored;
    if (holds(array.type, value)) read.mapping.missing.push_back(value);
    return unheld_note(name, value, array.type);
  };
  for (const char* const name : {"missing_value", "_FillValue"}) {
    std::vector<nlohmann::json> others;
    const std::vector<StoredValue> values = numbers_of_attribute(attributes, name, others);
    if (values.size() > kMostMissing) {
      read.obstacle = cat("its attribute ", name, " has ", values.size(), " values, and at most ", kMostMissing,
                          " are read, so which voxels hold no data is unknown; shorten it");
      continue;
    }
    if (!others.empty()) read.obstacle = not_numbers(attributes, name, others.front());
    std::string unheld;
    for (const StoredValue& stored : values) {
      const std::string note = add_missing(stored, name);
      if (unheld.empty()) unheld = note;
    }
    add_note(unheld, read.note);
  }
  if (array.missing_fill) add_missing(*array.missing_fill, "fill_value");
  add_note(unused_attribute(attributes), read.note);
  read.units = unit_text(json_string(attributes, "units"));
  read.long_name = json_string(attributes, "long_name");
}

std::string codec_obstacle(const ZarrArray& array) {
  if (has_library_codecs()) return {};
  for (const ZarrPacker packer : array.values().packers) {
    if (packer != ZarrPacker::zstd && packer != ZarrPacker::blosc) continue;
    return cat("packed by ", packer_name(packer),
               ", which this build of weir was left without; build it with libblosc-dev and libzstd-dev "
               "(WEIR_ZARR_CODECS=ON)");
  }
  return {};
}

}  // namespace

ArrayValues array_values(const ZarrArray& array) {
  ArrayValues values;
  read_attributes(array, values);
  if (const std::string obstacle = codec_obstacle(array); !obstacle.empty()) values.obstacle = obstacle;
  return values;
}

}  // namespace weir
