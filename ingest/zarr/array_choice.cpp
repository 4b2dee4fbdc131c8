#include "ingest/zarr/array_choice.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"
#include "ingest/source/convert_command.h"
#include "ingest/values/axis_placement.h"
#include "ingest/zarr/meaning/multiscales.h"
#include "ingest/zarr/metadata/zarr_json.h"

namespace weir {
namespace {

constexpr std::size_t kMostArraysShown = 8;  // in a message
constexpr std::size_t kAxesOfSpace = 3;

std::string without_slashes(std::string_view name) {
  while (name.starts_with('/')) name.remove_prefix(1);
  while (name.ends_with('/')) name.remove_suffix(1);
  return std::string(name);
}

/// The key of the finest level of the image that `node`, a group, is.
std::optional<std::string> finest_level(const ZarrNode& node) {
  const std::vector<Multiscale> images = multiscales_in(node.attributes);
  if (images.empty()) return std::nullopt;
  return joined_key(node.key, without_slashes(images.front().levels.front().path));
}

/// Whether the array `name` beside `node` has as many elements along its one axis as the axis of that name, as xarray
/// writes coordinates.
bool has_coordinates(ZarrStore& store, const ZarrNode& node, const std::string& name, std::int64_t extent) {
  const std::string group = node.key.substr(0, node.key.rfind('/') == std::string::npos ? 0 : node.key.rfind('/'));
  if (name.empty() || name.find('/') != std::string::npos || joined_key(group, name) == node.key) return false;
  try {
    const auto found = zarr_node(store, joined_key(group, name));
    return found && found->array && json_member(found->metadata, "shape") == nlohmann::json::array({extent});
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::interrupted) throw;
    return false;  // an array that cannot be read is none of this one's affairs
  }
}

std::string coordinates_note(ZarrStore& store, const ZarrNode& node, const ZarrArray& array) {
  if (array.shape.size() < kAxesOfSpace) return {};
  std::string names;
  bool of_space = false;
  for (std::size_t axis = 0; axis < array.shape.size(); ++axis) {
    if (!has_coordinates(store, node, array.axis_names[axis], array.shape[axis])) continue;
    names += cat(names.empty() ? "" : ", ", array.axis_names[axis]);
    of_space = of_space || axis + kAxesOfSpace >= array.shape.size();
  }
  return of_space ? cat("has coordinates ", names, ", which are not read from Zarr") : std::string();
}

ChosenArray meant_array(ZarrStore& store, ZarrNode node, LevelFinder& levels) {
  ChosenArray chosen{std::move(node), {}, {}};
  chosen.array = zarr_array(store, chosen.node);
  const auto level = levels.find(chosen.node.key);
  chosen.meaning = array_meaning(chosen.array, level);
  if (!level) chosen.meaning.coordinates_note = coordinates_note(store, chosen.node, chosen.array);
  return chosen;
}

std::string names_text(const std::vector<ZarrNode>& arrays) {
  std::string text;
  for (std::size_t i = 0; i < std::min(arrays.size(), kMostArraysShown); ++i) {
    text += cat(text.empty() ? "" : ", ", in_quotes(arrays[i].key));
  }
  if (arrays.size() > kMostArraysShown) text += cat(" and ", arrays.size() - kMostArraysShown, " more");
  return text;
}

ChosenArray named_array(ZarrStore& store, const std::string& path, const std::string& dataset, LevelFinder& levels) {
  const std::string key = without_slashes(dataset);
  auto node = zarr_node(store, key);
  if (node && !node->array) {
    const auto finest = finest_level(*node);
    node = finest ? zarr_node(store, *finest) : std::nullopt;
  }
  if (node && node->array) return meant_array(store, std::move(*node), levels);
  const std::vector<ZarrNode> arrays = zarr_arrays(store);
  throw input_error(
      path, cat("has no array ", in_quotes(dataset), "; it has ", arrays.empty() ? "none" : names_text(arrays)));
}

Error several_arrays(const std::string& path, const std::vector<DatasetInfo>& volumes) {
  Message commands;
  for (std::size_t i = 0; i < std::min(volumes.size(), kMostArraysShown); ++i) {
    commands +=
        compose(i == 0 ? "" : "; ", CommandLineText{convert_command(path, true, volumes[i]), volume_keys(volumes[i])});
  }
  if (volumes.size() > kMostArraysShown) {
    commands += cat("; and ", volumes.size() - kMostArraysShown, " more (weir inspect lists them)");
  }
  return usage_error(
      compose(path, ": holds ", volumes.size(), " volumes; choose one with ", option("dataset"), ": ", commands));
}

void add_placement(const ArrayMeaning& meaning, DatasetInfo& info) {
  const std::size_t rank = meaning.axes.size();
  if (rank < 3) return;
  const auto last = [rank](const std::vector<double>& of) { return Vector3{of[rank - 1], of[rank - 2], of[rank - 3]}; };
  const Vector3 spacing = last(meaning.scale);
  const Vector3 origin = last(meaning.translation);
  if (spacing != Vector3{1, 1, 1}) info.attributes.emplace_back("spacing x,y,z", vector_text(spacing));
  if (origin != Vector3{0, 0, 0}) info.attributes.emplace_back("origin x,y,z", vector_text(origin));
  const ScaleAxis& x = meaning.axes.back();
  if (!x.unit.empty()) info.attributes.emplace_back("unit of space", x.unit);
}

/// `error` without the document that it begins with.
std::string reason_of(const Error& error, const std::string& document) {
  const std::string text = error.what();
  const std::string prefix = document + ": ";
  return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
}

DatasetInfo describe_array(ZarrStore& store, const ZarrNode& node, LevelFinder& levels) {
  DatasetInfo info;
  info.name = node.key;
  const nlohmann::json& type = json_member(node.metadata, node.version == 3 ? "data_type" : "dtype");
  info.type = type.is_string() ? type.get<std::string>() : json_text(type);
  const std::string document = store.shown(node.document);
  try {
    info.extents = json_extents(json_member(node.metadata, "shape"), "shape", 0, document);
    const ChosenArray chosen = meant_array(store, node, levels);
    info.type = cat(chosen.array.values().big_endian ? "big-endian " : "", scalar_name(chosen.array.type));
    info.layout = chosen.array.layout_text();
    for (const ScaleAxis& axis : chosen.meaning.axes) {
      if (!axis.name.empty()) info.axis_names.push_back(axis.name);
    }
    if (!info.axis_names.empty()) info.attributes.emplace_back("axes", axes_text(chosen.array, chosen.meaning));
    info.attributes.emplace_back("fill value", chosen.array.fill_text);
    if (!chosen.meaning.units.empty()) info.attributes.emplace_back("units", chosen.meaning.units);
    add_placement(chosen.meaning, info);
    for (const std::string& note : {chosen.meaning.place_note, chosen.meaning.coordinates_note}) {
      if (!note.empty()) info.attributes.emplace_back("note", note);
    }
    info.obstacle = chosen.meaning.obstacle;
    info.index_axes = chosen.meaning.leading(chosen.array);
    const bool single = std::all_of(info.index_axes.begin(), info.index_axes.end(),
                                    [](const LeadingAxis& axis) { return axis.extent == 1; });
    info.leading_axes = info.obstacle.empty() && !single ? info.index_axes.size() : 0;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    info.obstacle = reason_of(error, document);
  }
  return info;
}

/// All arrays and what is listed of them, in one order.
struct ListedArrays {
  std::vector<ZarrNode> nodes;
  std::vector<DatasetInfo> infos;
};

ListedArrays listed_arrays(ZarrStore& store, const std::string& path, LevelFinder& levels) {
  ListedArrays listed{zarr_arrays(store), {}};
  if (listed.nodes.empty()) {
    throw input_error(path, "holds no array of Zarr (zarr.json or .zarray); name the directory or zip file of one");
  }
  const auto root = zarr_node(store, {});
  const auto finest = root && !root->array ? finest_level(*root) : std::nullopt;
  for (const ZarrNode& node : listed.nodes) {
    DatasetInfo info = describe_array(store, node, levels);
    const auto level = levels.find(node.key);
    info.by_name_only = finest ? node.key != *finest : level && level->level > 0;
    listed.infos.push_back(std::move(info));
  }
  return listed;
}

ChosenArray only_array(ZarrStore& store, const std::string& path, LevelFinder& levels) {
  ListedArrays listed = listed_arrays(store, path, levels);
  std::vector<DatasetInfo> volumes;
  std::optional<std::size_t> only;
  std::string obstacle;
  for (std::size_t i = 0; i < listed.infos.size(); ++i) {
    const DatasetInfo& info = listed.infos[i];
    if (info.obstacle.empty() && !info.by_name_only) {
      only = i;
      volumes.push_back(info);
    } else if (obstacle.empty() && !info.obstacle.empty()) {
      obstacle = cat(info.name, info.name.empty() ? "" : ": ", info.obstacle);
    }
  }
  if (volumes.size() > 1) throw several_arrays(path, volumes);
  if (only) return meant_array(store, std::move(listed.nodes[*only]), levels);
  throw input_error(path, listed.nodes.size() == 1
                              ? obstacle
                              : cat("none of its ", listed.nodes.size(), " arrays is a volume; the first is ", obstacle,
                                    "; weir inspect lists them"));
}

}  // namespace

ChosenArray choose_array(ZarrStore& store, const std::string& path, const std::string& dataset) {
  LevelFinder levels(store);
  if (!dataset.empty()) return named_array(store, path, dataset, levels);
  const auto root = zarr_node(store, {});
  if (root && root->array) return meant_array(store, *root, levels);
  if (root) {
    if (const auto finest = finest_level(*root)) return named_array(store, path, *finest, levels);
  }
  return only_array(store, path, levels);
}

std::vector<DatasetInfo> list_arrays(ZarrStore& store, const std::string& path) {
  LevelFinder levels(store);
  return listed_arrays(store, path, levels).infos;
}

}  // namespace weir
