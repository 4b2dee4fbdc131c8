#include "ingest/hdf5/meaning/dimension_scales.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_attribute.h"
#include "ingest/hdf5/file/hdf5_handle.h"

namespace weir {
namespace {

// The first scale of each axis; invalid where it has none. Empty where the attribute is not what it should be.
std::vector<Hdf5Handle> scales_of(hid_t dataset, std::size_t rank) {
  if (!has_attribute(dataset, "DIMENSION_LIST")) return {};
  const Hdf5Handle attribute(H5Aopen(dataset, "DIMENSION_LIST", H5P_DEFAULT));
  const Hdf5Handle type(H5Aget_type(attribute.get()));
  const Hdf5Handle space(H5Aget_space(attribute.get()));
  const Hdf5Handle wanted(H5Tvlen_create(H5T_STD_REF_OBJ));
  if (H5Tequal(type.get(), wanted.get()) <= 0 ||
      H5Sget_simple_extent_npoints(space.get()) != static_cast<hssize_t>(rank)) {
    return {};
  }
  std::vector<hvl_t> lists(rank, hvl_t{0, nullptr});
  std::vector<Hdf5Handle> scales;
  if (H5Aread(attribute.get(), wanted.get(), lists.data()) >= 0) {
    for (const hvl_t& list : lists) {
      scales.emplace_back(list.len == 0 ? H5I_INVALID_HID : H5Rdereference2(dataset, H5P_DEFAULT, H5R_OBJECT, list.p));
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

void read_coordinates(hid_t scale, AxisPlace& axis) {
  const Hdf5Handle type(H5Dget_type(scale));
  const Hdf5Handle space(H5Dget_space(scale));
  const H5T_class_t kind = H5Tget_class(type.get());
  if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || H5Sget_simple_extent_ndims(space.get()) != 1 ||
      H5Sget_simple_extent_npoints(space.get()) != axis.extent ||
      axis.extent > static_cast<std::int64_t>(kMaxCoordinates)) {
    return;
  }
  std::vector<double> coordinates(static_cast<std::size_t>(axis.extent));
  if (H5Dread(scale, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, coordinates.data()) < 0) return;
  const bool single = kind == H5T_FLOAT && H5Tget_precision(type.get()) <= 32;
  place_by_coordinates(
      coordinates,
      single ? static_cast<double>(std::numeric_limits<float>::epsilon()) : std::numeric_limits<double>::epsilon(),
      axis);
}

}  // namespace

void place_by_coordinates(std::span<const double> coordinates, double precision, AxisPlace& axis) {
  if (coordinates.empty() ||
      !std::all_of(coordinates.begin(), coordinates.end(), [](double c) { return std::isfinite(c); })) {
    return;
  }
  const double first = coordinates.front();
  const double last = coordinates.back();
  if (coordinates.size() == 1) {
    axis.origin = first;
    return;
  }
  const double spacing = (last - first) / static_cast<double>(coordinates.size() - 1);
  const double tolerance =
      kRegularTolerance * std::fabs(spacing) + precision * std::max(std::fabs(first), std::fabs(last));
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const double regular = first + static_cast<double>(i) * spacing;
    if (spacing == 0.0 || !std::isfinite(spacing) || std::fabs(coordinates[i] - regular) > tolerance) {
      axis.note = cat("irregular coordinates from ", first, " to ", last, ", taken as indices");
      return;
    }
  }
  axis.spacing = std::fabs(spacing);
  axis.origin = std::min(first, last);
  if (spacing < 0.0) axis.note = cat("coordinates fall from ", first, " to ", last, ": mirrored along this axis");
}

bool is_bare_dimension(hid_t dataset) {
  const std::vector<std::string> name = text_attribute(dataset, "NAME");
  return has_attribute(dataset, "CLASS") && !name.empty() &&
         name[0].starts_with("This is a netCDF dimension but not a netCDF variable");
}

void place_by_scales(hid_t dataset, std::span<AxisPlace> axes) {
  if (H5Iget_type(dataset) != H5I_DATASET) return;
  const std::vector<Hdf5Handle> scales = scales_of(dataset, axes.size());
  for (std::size_t i = 0; i < scales.size(); ++i) {
    if (!scales[i] || H5Iget_type(scales[i].get()) != H5I_DATASET) continue;
    if (axes[i].label.empty()) axes[i].label = last_part(scales[i].get());
    if (!axes[i].spacing && !is_bare_dimension(scales[i].get())) read_coordinates(scales[i].get(), axes[i]);
  }
}

}  // namespace weir
