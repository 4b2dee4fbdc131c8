#include "ingest/hdf5/meaning/dimension_scales.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/axes/coordinates.h"
#include "ingest/axes/space_axis.h"
#include "ingest/axes/time_axis.h"
#include "ingest/hdf5/file/hdf5_attribute.h"
#include "ingest/hdf5/file/hdf5_error.h"
#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/file/hdf5_type.h"
#include "ingest/hdf5/meaning/value_meaning.h"
#include "ingest/hdf5/storage/storage.h"
#include "ingest/values/decode_doubles.h"

namespace weir {
namespace {

// Returns the first scale of each axis. The handle is invalid if the axis has no scale, and invalid with a note if
// the scale cannot be opened. Returns an empty vector if the attribute is malformed.
std::vector<Hdf5Handle> scales_of(hid_t dataset, std::span<AxisPlace> axes) {
  const std::size_t rank = axes.size();
  if (!has_attribute(dataset, "DIMENSION_LIST")) return {};
  const Hdf5Handle attribute(H5Aopen(dataset, "DIMENSION_LIST", H5P_DEFAULT));
  if (!attribute) throw attribute_error(dataset, "DIMENSION_LIST");
  const Hdf5Handle type(H5Aget_type(attribute.get()));
  const Hdf5Handle space(H5Aget_space(attribute.get()));
  const Hdf5Handle wanted(H5Tvlen_create(H5T_STD_REF_OBJ));
  if (H5Tequal(type.get(), wanted.get()) <= 0 ||
      H5Sget_simple_extent_npoints(space.get()) != static_cast<hssize_t>(rank)) {
    return {};
  }
  std::vector<hvl_t> lists(rank, hvl_t{0, nullptr});
  std::vector<Hdf5Handle> scales;
  if (H5Aread(attribute.get(), wanted.get(), lists.data()) < 0) throw attribute_error(dataset, "DIMENSION_LIST");
  for (std::size_t i = 0; i < rank; ++i) {
    const hvl_t& list = lists[i];
    scales.emplace_back(list.len == 0 ? H5I_INVALID_HID : H5Rdereference2(dataset, H5P_DEFAULT, H5R_OBJECT, list.p));
    if (list.len > 0 && !scales.back() && !axes[i].spacing) {
      axes[i].note = cat("its coordinates cannot be opened (", hdf5_reason(), "), taken as indices");
    }
  }
  H5Dvlen_reclaim(wanted.get(), space.get(), H5P_DEFAULT, lists.data());
  return scales;
}

std::string last_part(hid_t object) {
  std::vector<char> name(1024, '\0');
  if (H5Iget_name(object, name.data(), name.size()) <= 0) return {};
  const std::string_view path(name.data());
  return std::string(path.substr(path.rfind('/') + 1));
}

// Returns the relative rounding error of a coordinate.
double precision_of(hid_t dataset) {
  const Hdf5Handle type(H5Dget_type(dataset));
  const bool single = H5Tget_class(type.get()) == H5T_FLOAT && H5Tget_precision(type.get()) <= 32;
  return single ? static_cast<double>(std::numeric_limits<float>::epsilon()) : std::numeric_limits<double>::epsilon();
}

// Returns which axes may grow without limit.
std::vector<bool> growing_axes(hid_t dataset, std::size_t rank) {
  std::vector<bool> grow(rank, false);
  const Hdf5Handle space(H5Dget_space(dataset));
  std::vector<hsize_t> dims(rank);
  std::vector<hsize_t> most(rank);
  if (rank == 0 || H5Sget_simple_extent_dims(space.get(), dims.data(), most.data()) != static_cast<int>(rank)) {
    return grow;
  }
  for (std::size_t i = 0; i < rank; ++i) grow[i] = most[i] == H5S_UNLIMITED;
  return grow;
}

// Returns whether only axis 0 may grow: a simulation has one unlimited NetCDF dimension.
bool first_alone(const std::vector<bool>& grow) {
  return !grow.empty() && grow[0] && std::count(grow.begin(), grow.end(), true) == 1;
}

// NetCDF-4 sets the length of an unlimited dimension at its scale, and the length of a variable at its last written
// record. If a scale that cannot grow is longer, it has another reason: the scale holds the edges of cells.
std::int64_t unwritten_elements(hid_t scale, std::int64_t extent) {
  const Hdf5Handle space(H5Dget_space(scale));
  hsize_t elements = 0;
  hsize_t most = 0;
  if (H5Sget_simple_extent_ndims(space.get()) != 1 || H5Sget_simple_extent_dims(space.get(), &elements, &most) != 1 ||
      most != H5S_UNLIMITED || elements > static_cast<hsize_t>(std::numeric_limits<std::int64_t>::max())) {
    return 0;
  }
  return std::max<std::int64_t>(static_cast<std::int64_t>(elements) - extent, 0);
}

// The library always unpacks a whole chunk, even to read few of its elements.
bool has_too_large_chunks(const Storage& storage) {
  return storage.chunk.size() == 1 && !storage.filters.empty() && storage.chunk[0] > kMaxCoordinateChunk;
}

void place_by_scale(hid_t scale, bool grows, AxisPlace& axis) {
  const std::string name = last_part(scale);
  if (axis.label.empty()) axis.label = name;
  if (is_bare_dimension(scale)) {
    axis.is_time = is_time_axis({name, {}, {}, {}, grows});
    return;
  }
  axis.has_coordinates = true;
  axis.units = first_text_attribute(scale, "units");
  axis.calendar = first_text_attribute(scale, "calendar");
  const std::string positive = first_text_attribute(scale, "positive");
  axis.is_time = is_time_axis({name, axis.units, first_text_attribute(scale, "axis"),
                               first_text_attribute(scale, "standard_name"), grows, positive});
  axis.points_down = is_down(positive);
  if (axis.spacing) return;
  if (const Storage storage = storage_of(scale); has_too_large_chunks(storage)) {
    axis.note = cat("its coordinates lie in packed chunks of ", storage.chunk[0], ", and at most ", kMaxCoordinateChunk,
                    " are read, taken as indices");
    return;
  }
  std::vector<double> coordinates = coordinate_values(scale);
  if (std::cmp_equal(coordinates.size(), axis.extent + axis.unwritten)) {
    coordinates.resize(static_cast<std::size_t>(axis.extent));  // which are those of the first records
  }
  if (std::cmp_not_equal(coordinates.size(), axis.extent)) {
    axis.note = coordinates.empty()
                    ? "its coordinates are no row of numbers, or packed by no number, taken as indices"
                    : cat("it has ", coordinates.size(), coordinates.size() == 1 ? " coordinate" : " coordinates",
                          " for ", axis.extent, " elements, taken as indices");
    return;
  }
  place_by_coordinates(std::move(coordinates), precision_of(scale), axis);
}

}  // namespace

std::vector<double> coordinate_values(hid_t dataset) {
  const auto cut_short = [&](const std::string& reason) {
    return input_error(object_text(dataset),
                       cat("its coordinates cannot be read: ", reason, "; the file is cut short or damaged"));
  };
  const Hdf5Handle type(H5Dget_type(dataset));
  const Hdf5Handle space(H5Dget_space(dataset));
  const H5T_class_t kind = H5Tget_class(type.get());
  const hssize_t points = H5Sget_simple_extent_npoints(space.get());
  if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || H5Sget_simple_extent_ndims(space.get()) > 1 || points < 1 ||
      points > static_cast<hssize_t>(kMaxCoordinates)) {
    return {};
  }
  const Storage storage = storage_of(dataset);
  if (has_too_large_chunks(storage)) return {};
  const auto count = static_cast<std::size_t>(points);
  const auto stored = stored_type(type.get());
  if (!stored) {
    std::vector<double> values(count);
    if (H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
      throw cut_short(hdf5_reason());
    return values;
  }
  const StoredType meant = type_as_meant(dataset, *stored);
  const ValueMeaning meaning = value_meaning(
      dataset, meant, storage.fill_is_set ? std::span<const std::byte>(storage.fill) : std::span<const std::byte>());
  if (!meaning.unpacks) return {};
  std::vector<std::byte> bytes(count * scalar_bytes(meant.scalar));
  if (H5Dread(dataset, type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0) {
    if (storage.obstacle.empty()) throw cut_short(hdf5_reason());
    throw input_error(object_text(dataset), cat("its coordinates cannot be read: ", storage.obstacle));
  }
  std::vector<double> values = decode_doubles(bytes, meant.scalar, meant.big_endian, meaning.mapping);
  if (std::none_of(values.begin(), values.end(), [](double v) { return std::isnan(v); })) return values;
  // A value inside a rising or falling row is valid, even if an attribute calls it missing.
  ValueMapping all = meaning.mapping;
  all.missing.clear();
  std::vector<double> kept = decode_doubles(bytes, meant.scalar, meant.big_endian, all);
  const auto unlike = [&](auto order) { return std::adjacent_find(kept.begin(), kept.end(), std::not_fn(order)); };
  const bool in_order = unlike(std::less<>()) == kept.end() || unlike(std::greater<>()) == kept.end();
  return in_order && std::isfinite(kept.front()) && std::isfinite(kept.back()) ? kept : values;
}

bool is_bare_dimension(hid_t dataset) {
  check_attribute_bytes(dataset);
  return has_attribute(dataset, "CLASS") &&
         first_text_attribute(dataset, "NAME").starts_with("This is a netCDF dimension but not a netCDF variable");
}

void place_by_scales(hid_t dataset, std::span<AxisPlace> axes) {
  if (H5Iget_type(dataset) != H5I_DATASET) return;
  const std::vector<Hdf5Handle> scales = scales_of(dataset, axes);
  const std::vector<bool> grow = growing_axes(dataset, axes.size());
  for (std::size_t i = 0; i < scales.size(); ++i) {
    if (!scales[i] || H5Iget_type(scales[i].get()) != H5I_DATASET) continue;
    axes[i].grows = grow[i];
    if (grow[i]) axes[i].unwritten = unwritten_elements(scales[i].get(), axes[i].extent);
    place_by_scale(scales[i].get(), i == 0 && first_alone(grow), axes[i]);
  }
  const std::vector<std::string> labels = text_attribute(dataset, "DIMENSION_LABELS");
  for (std::size_t i = 0; i < axes.size() && labels.size() == axes.size(); ++i) {
    if (!axes[i].label.empty() || labels[i].empty()) continue;
    axes[i].label = labels[i];
    axes[i].is_time = is_time_axis({labels[i], {}, {}, {}, false});
  }
}

}  // namespace weir
