#include <algorithm>
#include <span>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/axes/axis_details.h"
#include "ingest/hdf5/file/hdf5_attribute.h"
#include "ingest/hdf5/file/hdf5_file.h"
#include "ingest/hdf5/file/hdf5_walk.h"
#include "ingest/hdf5/hdf5_source.h"
#include "ingest/hdf5/meaning/axis_roles.h"
#include "ingest/hdf5/meaning/dataset_facts.h"
#include "ingest/hdf5/meaning/dimension_scales.h"
#include "ingest/hdf5/meaning/volume_slice.h"
#include "ingest/values/value_notes.h"

namespace weir {
namespace {

using Attributes = std::vector<std::pair<std::string, std::string>>;

void add(Attributes& attributes, std::string name, std::string value) {
  if (!value.empty()) attributes.emplace_back(std::move(name), std::move(value));
}

std::string missing_text(const ValueMapping& mapping) {
  std::string text;
  for (const StoredValue& value : mapping.missing) text += cat(text.empty() ? "" : ", ", stored_value_text(value));
  return text;
}

std::string packing_text(const ValueMapping& mapping) {
  return mapping.scales() ? cat("stored * ", mapping.scale, " + ", mapping.offset) : "";
}

// Adds the axes; `axes` do not include the axis of components.
void add_axes(std::span<const AxisPlace> axes, Attributes& attributes) {
  if (axes.size() < kVolumeRank) return;
  const auto& [z, y, x] = axis_roles(axes).volume;
  for (auto& listed : listed_axes({&axes[x], &axes[y], &axes[z]})) attributes.push_back(std::move(listed));
}

std::vector<LeadingAxis> axes_at(std::span<const AxisPlace> axes, const std::vector<std::size_t>& places) {
  std::vector<LeadingAxis> chosen;
  for (const std::size_t i : places) chosen.push_back({axes[i].label, axes[i].extent, axes[i].unwritten});
  return chosen;
}

// Adds the axes that --index counts, as volume_slice() counts them.
void add_index_axes(const DatasetFacts& facts, DatasetInfo& info) {
  if (facts.axes.size() < kVolumeRank) return;
  const std::span axes = facts.axes;
  const AxisRoles all = axis_roles(axes);
  const AxisRoles usual = axis_roles_beside(facts.components, axes);
  info.index_axes = axes_at(axes, usual.others);
  info.vector_index_axes = axes_at(axes, all.others);
  const ComponentAxis asked = asked_component_axis(axes, !all.interleaved());
  info.component_index_axes = axes_at(axes, axis_roles_beside(asked, axes).others);
  info.index_by_name = usual.interleaved();
}

DatasetInfo described(const Hdf5Object& object, const DatasetFacts& facts) {
  DatasetInfo info;
  info.name = object.name;
  for (const AxisPlace& axis : facts.axes) info.extents.push_back(axis.extent);
  info.type = facts.type_text;
  info.layout = facts.layout_text();
  for (const char* text : {"long_name", "description"}) {
    add(info.attributes, text, first_text_attribute(object.handle.get(), text));
  }
  add(info.attributes, "units", facts.meaning.units);
  if (facts.meaning.unit_si) add(info.attributes, "unit_si", cat(*facts.meaning.unit_si));
  add(info.attributes, "missing", missing_text(facts.meaning.mapping));
  add(info.attributes, "values", packing_text(facts.meaning.mapping));
  std::string notes = facts.meaning.note;
  add_note(facts.place_note, notes);
  add(info.attributes, "note", notes);
  const auto is_named = [](const AxisPlace& axis) { return !axis.label.empty(); };
  if (std::any_of(facts.axes.begin(), facts.axes.end(), is_named)) {
    add(info.attributes, "axes", axes_text(facts.axes));
    for (const AxisPlace& axis : facts.axes) {
      if (!axis.label.empty()) info.axis_names.push_back(axis.label);
    }
  }
  if (facts.components.found()) {
    add(info.attributes, "components",
        cat(facts.components.count, " along the last axis, ", facts.components.evidence));
  }
  const auto axes = std::span(facts.axes).first(facts.axes.size() - (facts.components.found() ? 1 : 0));
  add_index_axes(facts, info);
  add_axes(axes, info.attributes);
  info.components = facts.components.count;
  info.obstacle = facts.obstacle;
  info.over_time = facts.over_time;
  info.by_name_only = facts.marks;
  info.leading_axes = facts.obstacle.empty() ? leading_axes(facts.axes) : 0;
  return info;
}

}  // namespace

std::vector<DatasetInfo> list_hdf5(const std::string& path, const SourceOptions& options) {
  const Hdf5Lock lock;
  const Hdf5Handle file = open_hdf5_file(path);
  std::vector<DatasetInfo> datasets;
  const auto add_unread = [&](const UnreadObject& unread) {
    if (!options.lists_damaged && unread.elsewhere) return;
    if (!options.lists_damaged) throw input_error(path, cat(unread.name, ": ", unread.why));
    DatasetInfo& info = datasets.emplace_back();
    info.name = unread.name;
    info.obstacle = unread.why;
  };
  const auto add_dataset = [&](std::string name, Hdf5Handle handle) {
    const Hdf5Object object{std::move(handle), path, std::move(name)};
    try {
      if (is_bare_dimension(object.handle.get())) return;
      datasets.push_back(described(object, dataset_facts(file.get(), object)));
    } catch (const Error& error) {
      if (!options.lists_damaged || error.kind() != ErrorKind::input) throw;
      add_unread({object.name, reason_of(error, object.where())});
    }
  };
  walk_datasets(file.get(), "/", add_dataset, add_unread);
  return datasets;
}

}  // namespace weir
