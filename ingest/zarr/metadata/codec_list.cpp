#include "ingest/zarr/metadata/codec_list.h"

#include <algorithm>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"
#include "ingest/zarr/metadata/array_parts.h"
#include "ingest/zarr/metadata/zarr_json.h"

namespace weir {
namespace {

constexpr const char* kSharding = "sharding_indexed";
constexpr std::size_t kMostCodecs = 16;

const nlohmann::json& require_list(const nlohmann::json& codecs, const char* name, const std::string& where) {
  if (codecs.is_array() && !codecs.empty() && codecs.size() <= kMostCodecs) return codecs;
  throw input_error(where, cat(name, " is ", json_text(codecs), ", and must be a list of 1 to ", kMostCodecs,
                               " codecs; the file is damaged"));
}

// Appends the transpose `order` to the earlier transposes in `inner`, so that `inner` is all steps in one.
void transpose_by(const nlohmann::json& order, std::size_t axes, std::vector<std::size_t>& inner,
                  const std::string& where) {
  std::vector<std::size_t> step;
  if (order == "F") {
    for (std::size_t axis = axes; axis-- > 0;) step.push_back(axis);
  } else if (order != "C") {
    for (const std::int64_t axis : json_extents(order, "order of transpose", 0, where)) {
      step.push_back(static_cast<std::size_t>(axis));
    }
    std::vector<std::size_t> sorted = step;
    std::sort(sorted.begin(), sorted.end());
    bool fits = step.size() == axes;
    for (std::size_t axis = 0; fits && axis < axes; ++axis) fits = sorted[axis] == axis;
    if (!fits) {
      throw input_error(where,
                        cat("the order of transpose names not each of the ", axes, " axes once; the file is damaged"));
    }
  }
  if (step.empty()) return;
  if (inner.empty()) {
    inner = step;
    return;
  }
  for (std::size_t& axis : step) axis = inner[axis];
  inner = step;
}

bool read_endian(const nlohmann::json& configuration, std::size_t value_bytes, const std::string& where) {
  const nlohmann::json& endian = json_member(configuration, "endian");
  if (endian == "little" || (endian.is_null() && value_bytes == 1)) return false;
  if (endian == "big") return true;
  throw input_error(where, cat("endian is ", json_text(endian), ", and must be \"little\" or \"big\""));
}

/// Reads a chain of codecs without shards: transposes, bytes, packers.
ZarrCodecs read_chain(const nlohmann::json& list, std::size_t axes, std::size_t value_bytes, const std::string& where) {
  ZarrCodecs codecs;
  bool bytes = false;
  for (const nlohmann::json& codec : list) {
    const std::string name = extension_name(codec);
    const nlohmann::json& configuration = json_member(codec, "configuration");
    const auto packer = parse_packer(name);
    if (name == kSharding) {
      throw input_error(where, "has other codecs beside sharding_indexed; write the array with those inside");
    }
    if (!packer && name != "bytes" && name != "transpose") throw unsupported_codec(where, "codec", name);
    if (bytes != packer.has_value()) {
      throw input_error(where, cat("has the codec ", in_quotes(name), " where ",
                                   bytes ? "only codecs of bytes can stand" : "the codec bytes must stand before it",
                                   "; the file is damaged"));
    }
    if (packer) codecs.packers.push_back(*packer);
    if (name == "transpose") transpose_by(json_member(configuration, "order"), axes, codecs.transpose, where);
    if (name == "bytes") {
      codecs.big_endian = read_endian(configuration, value_bytes, where);
      bytes = true;
    }
  }
  if (!bytes) throw input_error(where, "has no codec bytes; the file is damaged");
  return codecs;
}

/// Returns whether `codecs`, the list of a stored object or of a chunk in a shard, makes it a shard.
bool is_sharded(const nlohmann::json& codecs) {
  return codecs.size() == 1 && extension_name(codecs.front()) == kSharding;
}

/// Reads the sharding of shards of `shard` elements. If their chunks are shards too, this function does not read their
/// codecs.
ZarrSharding read_sharding(const nlohmann::json& configuration, const std::vector<std::int64_t>& shard,
                           std::size_t value_bytes, const std::string& where) {
  ZarrSharding sharding;
  sharding.chunk = json_extents(json_member(configuration, "chunk_shape"), "chunk_shape of sharding_indexed", 1, where);
  require_same_axes(shard, sharding.chunk, "chunk_shape of sharding_indexed", where);
  for (std::size_t axis = 0; axis < sharding.chunk.size(); ++axis) {
    if (shard[axis] % sharding.chunk[axis] == 0) continue;
    throw input_error(where,
                      cat("its shards have ", shard[axis], " elements along axis ", axis, ", and the chunks in them ",
                          sharding.chunk[axis], ", which does not divide that; the file is damaged"));
  }
  const nlohmann::json& codecs =
      require_list(json_member(configuration, "codecs"), "codecs of sharding_indexed", where);
  if (!is_sharded(codecs)) sharding.codecs = read_chain(codecs, sharding.chunk.size(), value_bytes, where);
  const ZarrCodecs index =
      read_chain(require_list(json_member(configuration, "index_codecs"), "index_codecs", where), 0, 8, where);
  const bool checksum = index.packers == std::vector{ZarrPacker::crc32c};
  if (!checksum && !index.packers.empty()) {
    throw input_error(where, cat("index_codecs has ", in_quotes(packer_name(index.packers.front())),
                                 ", and weir reads indices with bytes and crc32c; write the array with those"));
  }
  sharding.index_checksum = checksum;
  sharding.index_big_endian = index.big_endian;
  const nlohmann::json& location = json_member(configuration, "index_location");
  if (!location.is_null() && location != "end" && location != "start") {
    throw input_error(where, cat("index_location is ", json_text(location), ", and must be \"start\" or \"end\""));
  }
  sharding.index_first = location == "start";
  return sharding;
}

}  // namespace

std::string extension_name(const nlohmann::json& extension) {
  return extension.is_string() ? extension.get<std::string>() : json_string(extension, "name");
}

void read_codecs(const nlohmann::json& codecs, ZarrArray& array, const std::string& where) {
  require_list(codecs, "codecs", where);
  const std::size_t value_bytes = scalar_bytes(array.type);
  const nlohmann::json* level = &codecs;
  while (is_sharded(*level)) {
    if (array.shards.size() == kMostShardLevels) {
      throw input_error(where, cat("has more than ", kMostShardLevels,
                                   " levels of shards in each other; write the array with fewer"));
    }
    const nlohmann::json& configuration = json_member(level->front(), "configuration");
    array.shards.push_back(read_sharding(configuration, array.unit(), value_bytes, where));
    level = &json_member(configuration, "codecs");
  }
  if (array.shards.empty()) array.codecs = read_chain(codecs, array.shape.size(), value_bytes, where);
}

}  // namespace weir
