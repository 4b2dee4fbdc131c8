#include "ingest/hdf5/meaning/dataset_facts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_attribute.h"
#include "ingest/hdf5/meaning/openpmd.h"
#include "ingest/hdf5/meaning/volume_slice.h"
#include "ingest/hdf5/meaning/vtk_hdf.h"
#include "ingest/values/decode_values.h"
#include "ingest/values/value_notes.h"

namespace weir {
namespace {

std::vector<std::int64_t> extents_of(hid_t dataset) {
  const Hdf5Handle space(H5Dget_space(dataset));
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank <= 0) return {};
  std::vector<hsize_t> dims(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.get(), dims.data(), nullptr);
  std::vector<std::int64_t> extents;
  extents.reserve(dims.size());
  for (const hsize_t d : dims) {
    extents.push_back(static_cast<std::int64_t>(std::min<hsize_t>(d, std::numeric_limits<std::int64_t>::max())));
  }
  return extents;
}

std::string type_obstacle(const DatasetFacts& facts) {
  if (facts.type) return {};
  if (facts.type_text.starts_with("integer")) {
    return cat("its type is ", facts.type_text,
               "; an integer's precision must be 8, 16, 32 or 64 bits, all that its bytes hold");
  }
  const bool labels = facts.type_text == "boolean" || facts.type_text.starts_with("enumeration");
  return cat("its type is ", facts.type_text, "; a volume has integers of 8 to 64 bits or floats of 16, 32 or 64",
             labels ? ", so store it as uint8" : "");
}

std::string shape_obstacle(const DatasetFacts& facts) {
  if (facts.axes.empty()) return "a single value; a volume has three axes";
  if (facts.axes.size() < kVolumeRank) {
    return cat(facts.axes.size(), facts.axes.size() == 1 ? " axis (" : " axes (", axes_text(facts.axes),
               "); a volume has three");
  }
  const auto is_empty = [](const AxisPlace& axis) { return axis.extent < 1; };
  return std::any_of(facts.axes.begin(), facts.axes.end(), is_empty) ? cat("empty: ", axes_text(facts.axes)) : "";
}

// Returns an obstacle for a series of planes over time: it looks like a volume, and its time steps look like a
// spacing.
std::string time_obstacle(const DatasetFacts& facts) {
  const auto axes = std::span(facts.axes).first(facts.axes.size() - (facts.components.found() ? 1 : 0));
  if (axes.size() < kVolumeRank) return {};
  const auto of_space = std::count_if(axes.begin(), axes.end(), [](const AxisPlace& axis) { return !axis.is_time; });
  if (of_space >= static_cast<std::ptrdiff_t>(kVolumeRank)) return {};
  return cat(of_space, of_space == 1 ? " axis" : " axes", " and time (", axes_text(facts.axes),
             "); a volume has three axes of space");
}

std::string component_obstacle(const DatasetFacts& facts) {
  if (facts.axes.size() <= kVolumeRank || !components_before_time(facts.axes)) return {};
  return cat("its components come before its time (", axes_text(facts.axes),
             "); write it with the components as the last axis");
}

// Returns whether a dataset that was never written reads as a real value, and not as a value that stands for missing
// data.
bool reads_as_data(hid_t object, const DatasetFacts& facts) {
  if (!facts.type || !facts.storage || !facts.storage->is_all_fill) return false;
  if (may_be_netcdf_fill(object, *facts.type, facts.storage->fill)) return false;
  std::array<float, 1> fill{};
  decode_values(facts.storage->fill, facts.type->scalar, facts.type->big_endian, facts.meaning.mapping, fill);
  return std::isfinite(fill[0]);
}

void look_at_constant(hid_t object, DatasetFacts& facts) {
  const std::vector<double> value = number_attribute(object, "value");
  facts.type_text = "constant";
  if (value.size() != 1) return;
  facts.constant = value[0];
  facts.type = StoredType{ScalarType::float64, false};
  facts.type_text = "float64";
}

}  // namespace

std::string DatasetFacts::layout_text() const {
  if (storage) return storage->text();
  return constant ? cat("constant ", *constant) : "";
}

DatasetFacts dataset_facts(hid_t file, const Hdf5Object& object) {
  const hid_t handle = object.handle.get();
  DatasetFacts facts;
  check_attribute_bytes(handle);
  const bool stored = is_dataset(handle);
  const std::vector<Hdf5Handle> groups = enclosing_groups(file, object.name);
  facts.marks = stored && is_vtk_hdf_mark(object, groups);
  facts.axes = axis_places(file, object, stored ? extents_of(handle) : openpmd_shape(handle));
  if (stored) {
    const Hdf5Handle type(H5Dget_type(handle));
    facts.type = stored_type(type.get());
    facts.type_text = type_text(type.get());
    if (const auto integers = enumerated_type(type.get())) {
      facts.type = integers;
      facts.type_text =
          cat(integers->big_endian ? "big-endian " : "", scalar_name(integers->scalar), " (", facts.type_text, ')');
    }
    const auto stored_as = facts.type;
    if (stored_as) facts.type = type_as_meant(handle, *stored_as);
    if (stored_as && facts.type->scalar != stored_as->scalar) {
      facts.type_text = cat(scalar_name(facts.type->scalar), " (stored as ", facts.type_text, ", _Unsigned)");
    }
    facts.storage = storage_of(handle);
  } else {
    look_at_constant(handle, facts);
  }
  facts.components = component_axis(facts.axes);
  for (const AxisPlace& axis : facts.axes) {
    if (facts.place_note.empty()) facts.place_note = axis.spacing_note;
  }
  if (facts.type) {
    const bool set = facts.storage && facts.storage->fill_is_set;
    facts.meaning = value_meaning(handle, *facts.type,
                                  set ? std::span<const std::byte>(facts.storage->fill) : std::span<const std::byte>());
  }
  add_note(unwritten_note(facts.axes), facts.meaning.note);
  if (reads_as_data(handle, facts)) facts.storage->obstacle.clear();
  for (const std::string& obstacle :
       {type_obstacle(facts), shape_obstacle(facts), facts.storage ? facts.storage->obstacle : std::string(),
        facts.meaning.obstacle, openpmd_obstacle(handle, groups), component_obstacle(facts)}) {
    if (facts.obstacle.empty()) facts.obstacle = obstacle;
  }
  if (facts.obstacle.empty()) {
    facts.obstacle = time_obstacle(facts);
    facts.over_time = !facts.obstacle.empty();
  }
  return facts;
}

}  // namespace weir
