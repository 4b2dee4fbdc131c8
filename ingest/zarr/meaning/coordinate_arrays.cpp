#include "ingest/zarr/meaning/coordinate_arrays.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/axes/coordinates.h"
#include "ingest/axes/space_axis.h"
#include "ingest/axes/time_axis.h"
#include "ingest/zarr/meaning/array_values.h"
#include "ingest/zarr/metadata/zarr_json.h"
#include "ingest/zarr/storage/zarr_numbers.h"

namespace weir {
namespace {

/// The most steps of an array that is read as an auxiliary time.
constexpr std::size_t kMostTimes = 65536;
constexpr std::size_t kKeptTimes = 16;

std::string group_of(const std::string& key) {
  const std::size_t slash = key.rfind('/');
  return slash == std::string::npos ? std::string() : key.substr(0, slash);
}

// Returns the node at `key` if it is an array whose metadata can be parsed as JSON, otherwise nullopt: a damaged
// neighbour must not stop the conversion of the array that the user wants.
std::optional<ZarrNode> array_at(ZarrStore& store, const std::string& key) {
  try {
    auto node = zarr_node(store, key);
    if (node && node->array) return node;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
  }
  return std::nullopt;
}

// Returns the array `name` in the nearest group around `key`, other than the array at `key` itself; nullopt if there
// is none.
std::optional<ZarrNode> array_near(ZarrStore& store, const std::string& key, const std::string& name) {
  if (name.empty() || name.find('/') != std::string::npos || key.empty()) return std::nullopt;
  for (std::string group = group_of(key);; group = group_of(group)) {
    const std::string near = joined_key(group, name);
    if (near != key) {
      if (auto found = array_at(store, near)) return found;
    }
    if (group.empty()) return std::nullopt;
  }
}

// A coordinate array that can be read, and the meaning of its values.
struct ReadableArray {
  ZarrArray array;
  ValueMapping mapping;
};

// Throws Error(input) if the array cannot be read, for example an array of texts.
ReadableArray readable(const ZarrStore& store, const ZarrNode& node) {
  ZarrArray array = zarr_array(store, node);
  array.missing_fill.reset();  // coordinates are never missing (CF 2.5.1), and zarr-python's fill is 0
  ArrayValues values = array_values(array);
  const std::string where = store.shown(node.key);
  if (!values.obstacle.empty()) throw input_error(where, values.obstacle);
  const std::int64_t chunk = array.unit().empty() ? 1 : array.unit().front();
  if (std::cmp_greater(chunk, kMaxCoordinateChunk)) {
    throw input_error(where,
                      cat("its chunks have ", chunk, " elements, and at most ", kMaxCoordinateChunk, " are read"));
  }
  return {std::move(array), std::move(values.mapping)};
}

double precision_of(ScalarType type) {
  const bool single = type == ScalarType::float32 || type == ScalarType::float16 || type == ScalarType::bfloat16;
  return single ? static_cast<double>(std::numeric_limits<float>::epsilon()) : std::numeric_limits<double>::epsilon();
}

void place_by_array(ZarrStore& store, const ZarrNode& found, AxisPlace& axis) {
  const auto attribute = [&](const char* name) { return json_string(found.attributes, name); };
  axis.has_coordinates = true;
  axis.units = attribute("units");
  axis.calendar = attribute("calendar");
  const std::string positive = attribute("positive");
  axis.is_time = is_time_axis({axis.label, axis.units, attribute("axis"), attribute("standard_name"), false, positive});
  axis.points_down = is_down(positive);
  if (std::cmp_greater(axis.extent, kMaxCoordinates)) {
    axis.note = cat("more than ", kMaxCoordinates, " coordinates, taken as indices");
    return;
  }
  std::optional<ReadableArray> coordinates;
  try {
    coordinates = readable(store, found);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    axis.note = cat("its coordinates cannot be read (", error.what(), "), taken as indices");
    return;
  }
  const double precision = precision_of(coordinates->array.type);
  std::vector<double> values = zarr_numbers(store, found.key, std::move(coordinates->array), coordinates->mapping);
  if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) {
    axis.note = "some of its coordinates are not numbers, taken as indices";
    return;
  }
  place_by_coordinates(std::move(values), precision, axis);
}

// Returns the times in `found`. Returns empty values if it is neither a single number nor one axis of at most
// kMostTimes, if a value is not finite, or if it cannot be read.
TimeValues time_in(ZarrStore& store, const ZarrNode& found) {
  const nlohmann::json& shape = json_member(found.metadata, "shape");
  const bool of_one_axis =
      shape.is_array() &&
      (shape.empty() || (shape.size() == 1 && shape[0].is_number_integer() && shape[0] > 0 && shape[0] <= kMostTimes));
  TimeValues time;
  if (!of_one_axis) return time;
  try {
    ReadableArray times = readable(store, found);
    std::vector<double> values = zarr_numbers(store, found.key, std::move(times.array), times.mapping);
    if (std::ranges::any_of(values, [](double value) { return !std::isfinite(value); })) return time;
    time = {std::move(values), json_string(found.attributes, "units"), json_string(found.attributes, "calendar")};
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;  // the volume can be read without its time
  }
  return time;
}

}  // namespace

const AxisPlace& CoordinateArrays::placed(const ZarrNode& found, const AxisPlace& axis) {
  if (const auto kept = placed_.find(found.key); kept != placed_.end()) return kept->second;
  AxisPlace placed = axis;
  place_by_array(store_, found, placed);
  kept_ += placed.coordinates.size();
  if (kept_ > kMaxCoordinates) {
    placed_.clear();
    kept_ = placed.coordinates.size();
  }
  return placed_[found.key] = std::move(placed);
}

void CoordinateArrays::place(const std::string& key, std::span<AxisPlace> axes) {
  for (AxisPlace& axis : axes) {
    if (axis.extent < 1) continue;
    const auto found = array_near(store_, key, axis.label);
    if (found && json_member(found->metadata, "shape") == nlohmann::json::array({axis.extent})) {
      axis = placed(*found, axis);
    }
  }
}

std::optional<TimeValues> CoordinateArrays::auxiliary_time(const std::string& key, const nlohmann::json& attributes,
                                                           std::span<const AxisPlace> axes) {
  for (const std::string& name : split(json_string(attributes, "coordinates"), ' ')) {
    const auto found = array_near(store_, key, name);
    if (!found || json_string(found->attributes, "units").find(" since ") == std::string::npos) continue;
    if (times_.size() >= kKeptTimes) times_.clear();
    const auto [kept, is_new] = times_.try_emplace(found->key);
    if (is_new) kept->second = time_in(store_, *found);
    const std::size_t count = kept->second.values.size();
    const auto has_as_many = [&](const AxisPlace& axis) { return axis.is_time && std::cmp_equal(axis.extent, count); };
    if (count == 1 || (count > 1 && std::ranges::any_of(axes, has_as_many))) return kept->second;
  }
  return std::nullopt;
}

}  // namespace weir
