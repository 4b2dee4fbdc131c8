#include "ingest/zarr/array_choice.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/axes/axis_details.h"
#include "ingest/headers/header_text.h"
#include "ingest/headers/named_choice.h"
#include "ingest/source/convert_command.h"
#include "ingest/source/left_out.h"
#include "ingest/values/value_notes.h"
#include "ingest/zarr/meaning/multiscales.h"
#include "ingest/zarr/meaning/outer_store.h"
#include "ingest/zarr/metadata/zarr_json.h"

namespace weir {
namespace {

constexpr std::size_t kMostArraysShown = 8;  // in a message
constexpr std::size_t kAxesOfSpace = 3;

/// Returns the key of the finest level if the group `node` is an image; nullopt otherwise.
std::optional<std::string> finest_level(const ZarrNode& node) {
  const std::vector<Multiscale> images = multiscales_in(node.attributes);
  if (images.empty()) return std::nullopt;
  return joined_key(node.key, images.front().levels.front().path);
}

/// The context that groups give to the arrays in them: the groups of the store, or, if the store is a single array,
/// the groups around it. For one thread at a time.
class Surroundings {
 public:
  /// `store` must outlive this object.
  Surroundings(ZarrStore& store, const std::string& path)
      : outer_(outer_store(store, path)),
        levels_(outer_.store ? *outer_.store : store),
        coordinates_(outer_.store ? *outer_.store : store) {}

  std::optional<FoundLevel> level_of(const ZarrNode& node) { return levels_.find(key_of(node)); }

  ArrayMeaning meaning_of(const ZarrNode& node, const ZarrArray& array) {
    const auto level = level_of(node);
    ArrayAxes axes = array_axes(array, level);
    if (level || array.shape.size() < kAxesOfSpace) return array_meaning(array, std::move(axes));
    coordinates_.place(key_of(node), axes.places);
    ArrayMeaning meaning = array_meaning(array, std::move(axes));
    meaning.auxiliary_time = coordinates_.auxiliary_time(key_of(node), node.attributes, meaning.axes.places);
    return meaning;
  }

 private:
  std::string key_of(const ZarrNode& node) const { return joined_key(outer_.key, node.key); }

  OuterStore outer_;
  LevelFinder levels_;
  CoordinateArrays coordinates_;
};

ChosenArray meant_array(ZarrStore& store, ZarrNode node, Surroundings& around) {
  ZarrArray array = zarr_array(store, node);
  ArrayMeaning meaning = around.meaning_of(node, array);
  return {std::move(node), std::move(array), std::move(meaning)};
}

std::string names_text(const std::vector<ZarrNode>& arrays) {
  std::string text;
  for (std::size_t i = 0; i < std::min(arrays.size(), kMostArraysShown); ++i) {
    text += cat(text.empty() ? "" : ", ", in_quotes(arrays[i].key));
  }
  if (arrays.size() > kMostArraysShown) text += cat(" and ", arrays.size() - kMostArraysShown, " more");
  return text;
}

ChosenArray named_array(ZarrStore& store, const std::string& path, const std::string& dataset, Surroundings& around) {
  const std::string key = without_slashes(dataset);
  auto node = zarr_node(store, key);
  if (node && !node->array) {
    const auto finest = finest_level(*node);
    node = finest ? zarr_node(store, *finest) : std::nullopt;
  }
  if (node && node->array) return meant_array(store, std::move(*node), around);
  const std::vector<ZarrNode> arrays = zarr_arrays(store);
  throw input_error(
      path, cat("has no array ", in_quotes(dataset), "; it has ", arrays.empty() ? "none" : names_text(arrays)));
}

Error several_arrays(const std::string& path, const std::vector<DatasetInfo>& volumes) {
  std::vector<Message> commands;
  for (const DatasetInfo& info : volumes) {
    commands.emplace_back(CommandLineText{convert_command(path, true, info), volume_keys(info)});
  }
  return several_volumes(path, "volumes", volumes.size(), commands);
}

void add_units(const VolumeAxes& axes, DatasetInfo& info) {
  const auto& [x, y, z] = axes;
  if (x->is_time || y->is_time || z->is_time) return;
  if (x->units == y->units && y->units == z->units) {
    if (!x->units.empty()) info.attributes.emplace_back("unit of space", x->units);
    return;
  }
  const auto unit = [](const AxisPlace* axis) { return axis->units.empty() ? std::string("none") : axis->units; };
  info.attributes.emplace_back("units of x,y,z", cat(unit(x), ", ", unit(y), ", ", unit(z)));
}

DatasetInfo describe_array(ZarrStore& store, const ZarrNode& node, Surroundings& around) {
  DatasetInfo info;
  info.name = node.key;
  const nlohmann::json& type = json_member(node.metadata, node.version == 3 ? "data_type" : "dtype");
  info.type = type.is_string() ? type.get<std::string>() : json_text(type);
  const std::string document = store.shown(node.document);
  try {
    info.extents = json_extents(json_member(node.metadata, "shape"), "shape", 0, document);
    const ChosenArray chosen = meant_array(store, node, around);
    info.type = cat(chosen.array.values().big_endian ? "big-endian " : "", scalar_name(chosen.array.type));
    info.layout = chosen.array.layout_text();
    for (const AxisPlace& axis : chosen.meaning.axes.places) {
      if (!axis.label.empty()) info.axis_names.push_back(axis.label);
    }
    if (!info.axis_names.empty()) info.attributes.emplace_back("axes", chosen.meaning.axes.text());
    info.attributes.emplace_back("fill value", chosen.array.fill_text);
    if (!chosen.meaning.values.units.empty()) info.attributes.emplace_back("units", chosen.meaning.values.units);
    if (const ComponentAxis& vectors = chosen.meaning.components; vectors.found()) {
      info.components = vectors.count;
      info.attributes.emplace_back("components", cat(vectors.count, " along the last axis, ", vectors.evidence));
    }
    if (info.extents.size() >= kAxesOfSpace) {
      const VolumeAxes axes = chosen.meaning.volume_axes();
      for (auto& listed : listed_axes(axes)) info.attributes.push_back(std::move(listed));
      add_units(axes, info);
    }
    std::string notes = chosen.meaning.axes.note;
    add_note(chosen.meaning.values.note, notes);
    if (!notes.empty()) info.attributes.emplace_back("note", std::move(notes));
    info.obstacle = chosen.meaning.obstacle;
    info.over_time = chosen.meaning.over_time;
    info.index_axes = chosen.meaning.leading();
    info.component_index_axes = chosen.meaning.leading_before(asked_component_axis(chosen.meaning.axes.places));
    info.vector_index_axes = chosen.meaning.leading_before({});
    const bool single = std::all_of(info.index_axes.begin(), info.index_axes.end(),
                                    [](const LeadingAxis& axis) { return axis.extent == 1; });
    info.leading_axes = info.obstacle.empty() && !single ? info.index_axes.size() : 0;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    info.obstacle = reason_of(error, document);
  }
  return info;
}

/// All arrays and their descriptions, in the same order.
struct ListedArrays {
  std::vector<ZarrNode> nodes;
  std::vector<DatasetInfo> infos;
};

ListedArrays listed_arrays(ZarrStore& store, const std::string& path, Surroundings& around) {
  ListedArrays listed{zarr_arrays(store), {}};
  if (listed.nodes.empty()) {
    throw input_error(path, "holds no array of Zarr (zarr.json or .zarray); name the directory or zip file of one");
  }
  const auto root = zarr_node(store, {});
  const auto finest = root && !root->array ? finest_level(*root) : std::nullopt;
  for (const ZarrNode& node : listed.nodes) {
    DatasetInfo info = describe_array(store, node, around);
    const auto level = around.level_of(node);
    info.by_name_only = !node.key.empty() && (finest ? node.key != *finest : level && level->level > 0);
    listed.infos.push_back(std::move(info));
  }
  return listed;
}

void say_left_out(const std::string& path, const std::string& taken, const std::vector<DatasetInfo>& infos,
                  const Notice& notice) {
  std::vector<LeftOut> left_out;
  for (const DatasetInfo& info : infos) {
    if (is_unread_volume(info)) left_out.push_back({info.name, info.obstacle});
  }
  if (notice && !left_out.empty()) notice(left_out_notice(path, taken, left_out));
}

ChosenArray only_array(ZarrStore& store, const std::string& path, const SourceOptions& options, Surroundings& around) {
  ListedArrays listed = listed_arrays(store, path, around);
  const auto has_components = [](const DatasetInfo& info) { return info.components > 1 && info.obstacle.empty(); };
  const bool of_vectors = options.component && std::ranges::any_of(listed.infos, has_components);
  std::vector<DatasetInfo> volumes;
  std::optional<std::size_t> only;
  std::string obstacle;
  for (std::size_t i = 0; i < listed.infos.size(); ++i) {
    const DatasetInfo& info = listed.infos[i];
    if (of_vectors && !has_components(info)) continue;
    if (info.obstacle.empty() && !info.by_name_only) {
      only = i;
      volumes.push_back(info);
    } else if (obstacle.empty() && !info.obstacle.empty()) {
      obstacle = cat(info.name, info.name.empty() ? "" : ": ", info.obstacle);
    }
  }
  if (volumes.size() > 1) throw several_arrays(path, volumes);
  if (only) {
    say_left_out(path, listed.infos[*only].name, listed.infos, options.notice);
    return meant_array(store, std::move(listed.nodes[*only]), around);
  }
  throw input_error(path, listed.nodes.size() == 1
                              ? obstacle
                              : cat("none of its ", listed.nodes.size(), " arrays is a volume; the first is ", obstacle,
                                    "; weir inspect lists them"));
}

}  // namespace

ChosenArray choose_array(ZarrStore& store, const std::string& path, const SourceOptions& options) {
  const std::string& dataset = options.dataset;
  Surroundings around(store, path);
  if (!dataset.empty()) return named_array(store, path, dataset, around);
  const auto root = zarr_node(store, {});
  if (root && root->array) return meant_array(store, *root, around);
  if (root) {
    if (const auto finest = finest_level(*root)) return named_array(store, path, *finest, around);
  }
  return only_array(store, path, options, around);
}

std::vector<DatasetInfo> list_arrays(ZarrStore& store, const std::string& path) {
  Surroundings around(store, path);
  return listed_arrays(store, path, around).infos;
}

}  // namespace weir
