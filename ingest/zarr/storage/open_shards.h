// A cache of open shards and their indices, kept while chunks are read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "ingest/zarr/metadata/zarr_array.h"
#include "ingest/zarr/storage/shard_index.h"
#include "ingest/zarr/store/zarr_store.h"

namespace weir {

/// The place of a shard's bytes: an object, or a part of an object.
struct ShardBytes {
  std::shared_ptr<ZarrObject> object;
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
  std::string shown;  ///< name of the shard, with which messages begin
};

struct OpenShard {
  std::string key;
  std::shared_ptr<ZarrObject> object;  ///< nullptr: the shard is a part of an object
  std::vector<ShardPlace> places;      ///< offsets count from the start of the object
};

/// The open shards of one level. Thread-safe.
class OpenShards {
 public:
  /// Whether shards are whole objects or parts of objects. Parts do not keep their object open; the outermost shard
  /// does.
  enum class Kind { objects, parts };

  /// Keeps the shards that were used last: as many as a sixteenth of `memory` bytes has room for, at most
  /// kMostOpenShards. Each shard has `chunks` chunks. Throws Error(usage), beginning with `where`, if a single index
  /// needs more than a sixteenth of `memory`.
  OpenShards(Kind kind, const ZarrSharding& sharding, std::uint64_t chunks, std::uint64_t memory,
             const std::string& where);

  static constexpr std::size_t kMostOpenShards = 64;

  std::uint64_t working_bytes() const { return most_ * index_bytes_ * 2; }

  /// Returns the shard `key`; calls open() and reads its index if it is not kept. Throws the errors of
  /// parse_shard_index, and Error(input) if the shard is shorter than its index.
  std::shared_ptr<const OpenShard> get(const std::string& key, const std::function<ShardBytes()>& open);

 private:
  std::shared_ptr<OpenShard> load(const std::string& key, ShardBytes shard) const;

  Kind kind_;
  ZarrSharding sharding_;
  std::uint64_t index_bytes_;
  std::size_t most_;
  std::mutex mutex_;
  std::list<std::shared_ptr<const OpenShard>> kept_;  ///< most recently used first
};

}  // namespace weir
