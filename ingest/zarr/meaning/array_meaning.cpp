#include "ingest/zarr/meaning/array_meaning.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/source/extent.h"
#include "ingest/source/unsigned_meaning.h"
#include "ingest/zarr/codecs/library_codecs.h"
#include "ingest/zarr/metadata/fill_value.h"
#include "ingest/zarr/metadata/zarr_json.h"

namespace weir {
namespace {

constexpr std::size_t kSpaceRank = 3;
constexpr std::size_t kMostMissing = 64;  // values that stand for no data, in one attribute

std::optional<StoredValue> number_of_attribute(const nlohmann::json& value) {
  if (const auto number = json_number(value)) return number;
  if (const auto packed = double_in_base64(value)) return StoredValue{*packed};
  if (value.is_boolean()) return StoredValue{std::int64_t{value.get<bool>() ? 1 : 0}};
  return value.is_string() ? parse_stored_value(value.get<std::string>()) : std::nullopt;
}

// A number, or a list of them as NetCDF's attributes are; what is none goes to `others`.
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

// The attribute as one finite number; `fallback` where it is absent.
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

// By the conventions of CF (8.1 and 2.5.1), as xarray writes them.
void read_value_attributes(const ZarrArray& array, ArrayMeaning& meaning) {
  const nlohmann::json& attributes = array.attributes;
  const bool meant_unsigned = says_unsigned(attributes);
  meaning.mapping.scale = packing(attributes, "scale_factor", 1.0, meaning.obstacle);
  meaning.mapping.offset = packing(attributes, "add_offset", 0.0, meaning.obstacle);
  const auto add_missing = [&](const StoredValue& stored) {
    const StoredValue value = meant_unsigned ? as_unsigned(stored, array.type) : stored;
    if (holds(array.type, value)) meaning.mapping.missing.push_back(value);
  };
  for (const char* const name : {"missing_value", "_FillValue"}) {
    std::vector<nlohmann::json> others;
    const std::vector<StoredValue> values = numbers_of_attribute(attributes, name, others);
    if (values.size() > kMostMissing) {
      meaning.obstacle = cat("its attribute ", name, " has ", values.size(), " values, and at most ", kMostMissing,
                             " are read, so which voxels hold no data is unknown; shorten it");
      continue;
    }
    if (!others.empty()) meaning.obstacle = not_numbers(attributes, name, others.front());
    for (const StoredValue& stored : values) add_missing(stored);
  }
  if (array.missing_fill) add_missing(*array.missing_fill);
  meaning.units = json_string(attributes, "units");
  meaning.long_name = json_string(attributes, "long_name");
}

std::string shape_obstacle(const ZarrArray& array, const ArrayMeaning& meaning) {
  const std::size_t rank = array.shape.size();
  if (rank < kSpaceRank) {
    return rank == 0 ? "a single value; a volume has three axes"
                     : cat(rank, rank == 1 ? " axis (" : " axes (", axes_text(array, meaning), "); a volume has three");
  }
  if (std::count(array.shape.begin(), array.shape.end(), 0) > 0) return cat("empty: ", axes_text(array, meaning));
  const auto is_other = [](const ScaleAxis& axis) { return !axis.type.empty() && axis.type != "space"; };
  const auto others = std::count_if(meaning.axes.end() - kSpaceRank, meaning.axes.end(), is_other);
  if (others == 0) {
    return extent_obstacle({array.shape[rank - 1], array.shape[rank - 2], array.shape[rank - 3]},
                           scalar_bytes(array.type));
  }
  return cat(static_cast<std::int64_t>(kSpaceRank) - others, " axes of space at its end (", axes_text(array, meaning),
             "); a volume has three");
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

std::string axes_text(const ZarrArray& array, const ArrayMeaning& meaning) {
  std::string text;
  for (std::size_t axis = 0; axis < array.shape.size(); ++axis) {
    const std::string& name = meaning.axes[axis].name;
    text += cat(text.empty() ? "" : ", ", name, name.empty() ? "" : " ", array.shape[axis]);
  }
  return text;
}

std::vector<LeadingAxis> ArrayMeaning::leading(const ZarrArray& array) const {
  std::vector<LeadingAxis> leading;
  for (std::size_t axis = 0; axis + kSpaceRank < array.shape.size(); ++axis) {
    leading.push_back({axes[axis].name, array.shape[axis]});
  }
  return leading;
}

ArrayMeaning array_meaning(const ZarrArray& array, const std::optional<FoundLevel>& level) {
  const std::size_t rank = array.shape.size();
  ArrayMeaning meaning;
  meaning.axes.resize(rank);
  meaning.scale.assign(rank, 1.0);
  meaning.translation.assign(rank, 0.0);
  for (std::size_t axis = 0; axis < rank; ++axis) meaning.axes[axis].name = array.axis_names[axis];
  if (level) {
    const ScaleLevel& found = level->image.levels[level->level];
    if (level->image.axes.size() == rank) meaning.axes = level->image.axes;
    const bool fits = found.scale.size() == rank;
    if (fits) {
      meaning.scale = found.scale;
      meaning.translation = found.translation;
    }
    if (!found.placed || (!fits && !found.scale.empty())) {
      meaning.place_note =
          cat("its coordinateTransformations are others than scale and translation by ",
              found.placed ? cat(rank, " numbers, one for each axis") : "numbers", ", taken as indices");
    }
  }
  read_value_attributes(array, meaning);
  for (const std::string& obstacle : {codec_obstacle(array), shape_obstacle(array, meaning)}) {
    if (!obstacle.empty()) meaning.obstacle = obstacle;
  }
  return meaning;
}

std::vector<std::int64_t> checked_index(const ZarrArray& array, const ArrayMeaning& meaning,
                                        const std::vector<std::int64_t>& index, const std::string& where) {
  const std::vector<LeadingAxis> leading = meaning.leading(array);
  const bool single =
      std::all_of(leading.begin(), leading.end(), [](const LeadingAxis& axis) { return axis.extent == 1; });
  if (index.empty() && single) return std::vector<std::int64_t>(leading.size(), 0);
  const auto refuse = [&](const Message& found) {
    std::string ranges;
    for (std::size_t axis = 0; axis < leading.size(); ++axis) {
      const std::string name = leading[axis].name.empty() ? cat("axis ", axis) : leading[axis].name;
      ranges += cat(ranges.empty() ? "" : ", ", name, " in 0..", leading[axis].extent - 1);
    }
    const Message remedy = leading.empty() ? compose("leave ", option("index"), " out")
                                           : compose("give ", option("index"), " with ", leading.size(),
                                                     leading.size() == 1 ? " position: " : " positions: ", ranges);
    return usage_error(compose(where, ": its axes are ", axes_text(array, meaning), found, "; ", remedy));
  };
  if (index.empty()) throw refuse(", and a volume has three");
  if (index.size() != leading.size()) {
    throw refuse(
        compose(", and ", option("index"), " has ", index.size(), index.size() == 1 ? " position" : " positions"));
  }
  for (std::size_t axis = 0; axis < leading.size(); ++axis) {
    if (index[axis] >= 0 && index[axis] < leading[axis].extent) continue;
    throw refuse(compose(", and ", option("index"), " has ", index[axis]));
  }
  return index;
}

void describe_volume(const ZarrArray& array, const ArrayMeaning& meaning, const std::vector<std::int64_t>& index,
                     SourceInfo& info) {
  const std::size_t rank = array.shape.size();
  info.extent = {array.shape[rank - 1], array.shape[rank - 2], array.shape[rank - 3]};
  info.index = index;
  info.type = array.type;
  info.mapping = meaning.mapping;
  info.units = meaning.units;
  info.details.long_name = meaning.long_name;
  info.details.coordinates_note = meaning.coordinates_note;
  for (std::size_t i = 0; i < kSpaceRank; ++i) {
    const std::size_t axis = rank - 1 - i;
    info.spacing.at(i) = meaning.scale[axis];
    info.origin.at(i) = meaning.translation[axis];
    info.axis_labels.at(i) = meaning.axes[axis].name;
    info.details.axes.at(i).units = meaning.axes[axis].unit;
    info.details.axes.at(i).note = meaning.place_note;
  }
  for (std::size_t axis = 0; axis < index.size(); ++axis) {
    if (meaning.axes[axis].type != "time") continue;
    const double time = static_cast<double>(index[axis]) * meaning.scale[axis] + meaning.translation[axis];
    info.details.time = TimePoint{time, meaning.axes[axis].unit, {}};
  }
}

}  // namespace weir
