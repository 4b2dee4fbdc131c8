#include "ingest/zarr/meaning/zarr_nodes.h"

#include <utility>

#include "format/base/ascii.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/source/unsigned_meaning.h"
#include "ingest/zarr/metadata/array_v2.h"
#include "ingest/zarr/metadata/array_v3.h"
#include "ingest/zarr/metadata/zarr_json.h"

namespace weir {
namespace {

constexpr const char* kAttributesV2 = ".zattrs";

nlohmann::json attributes_v2(ZarrStore& store, const std::string& key) {
  const std::string document = joined_key(key, kAttributesV2);
  const auto text = store.text(document);
  return text ? parse_zarr_json(*text, store.shown(document)) : nlohmann::json::object();
}

/// The state of a walk over all nodes.
struct ZarrWalk {
  ZarrStore& store;
  std::size_t nodes = 0;
  std::uint64_t bytes = 0;  ///< of metadata, in all nodes
  std::size_t values = 0;   ///< of JSON, in the metadata of arrays
  std::vector<ZarrNode> arrays;
};

void add_arrays(ZarrWalk& walk, const std::string& key, std::size_t depth) {
  auto node = zarr_node(walk.store, key);
  const auto bytes_of = [&](const std::string& document) {
    return walk.store.look(document).value_or(ZarrObjectState{}).bytes;
  };
  if (node) walk.bytes += bytes_of(node->document);
  if (node && node->version == 2) walk.bytes += bytes_of(joined_key(key, kAttributesV2));
  if (++walk.nodes > kMostZarrNodes || depth > kMostZarrDepth || walk.bytes > kMostWalkedBytes) {
    throw input_error(walk.store.shown({}), cat("has more than ", kMostZarrNodes, " groups and arrays, ",
                                                kMostZarrDepth, " groups in each other or ", kMostWalkedBytes,
                                                " bytes of metadata; name a group or an array in it"));
  }
  if (node && node->array) {
    walk.values += json_values(node->metadata) + json_values(node->attributes);
    if (walk.values > kMostWalkedValues) {
      throw input_error(walk.store.shown({}), cat("has more than ", kMostWalkedValues,
                                                  " JSON values in the metadata of its arrays; name a "
                                                  "group or an array in it"));
    }
    walk.arrays.push_back(std::move(*node));
    return;
  }
  // The root of a zip file may be a directory without metadata that holds the hierarchy.
  if (!node && depth > 1) return;
  for (const std::string& name : walk.store.groups_in(key)) add_arrays(walk, joined_key(key, name), depth + 1);
}

}  // namespace

std::optional<ZarrNode> zarr_node(ZarrStore& store, const std::string& key) {
  ZarrNode node;
  node.key = key;
  node.document = joined_key(key, "zarr.json");
  if (const auto text = store.text(node.document)) {
    node.metadata = parse_zarr_json(*text, store.shown(node.document));
    node.array = json_member(node.metadata, "node_type") != "group";
    if (node.metadata.contains("attributes")) node.attributes = std::move(node.metadata["attributes"]);
    return node;
  }
  node.version = 2;
  node.document = joined_key(key, ".zarray");
  if (const auto text = store.text(node.document)) {
    node.array = true;
    node.metadata = parse_zarr_json(*text, store.shown(node.document));
    node.attributes = attributes_v2(store, key);
    return node;
  }
  node.document = joined_key(key, ".zgroup");
  if (!store.look(node.document)) return std::nullopt;
  node.attributes = attributes_v2(store, key);
  return node;
}

std::string unsigned_text(const nlohmann::json& attributes) {
  const nlohmann::json& value = json_member(attributes, "_Unsigned");
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  return value.is_string() ? value.get<std::string>() : "";
}

ZarrArray zarr_array(const ZarrStore& store, const ZarrNode& node) {
  const std::string where = store.shown(node.document);
  ZarrArray array =
      node.version == 3 ? parse_zarr_v3(node.metadata, where) : parse_zarr_v2(node.metadata, node.attributes, where);
  if (node.version == 3) array.attributes = node.attributes;
  const ScalarType stored = array.type;
  array.type = meant_type(unsigned_text(array.attributes), stored);
  if (array.type == stored) return array;
  const auto fill = parse_stored_value(array.fill_text);
  if (fill) array.fill_text = stored_value_text(as_meant(*fill, array.type));
  return array;
}

std::vector<ZarrNode> zarr_arrays(ZarrStore& store) {
  ZarrWalk walk{store, 0, 0, 0, {}};
  add_arrays(walk, {}, 0);
  return std::move(walk.arrays);
}

}  // namespace weir
