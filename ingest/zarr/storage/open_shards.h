// Shards whose indices are kept while their chunks are read.
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

/// The bytes of a shard: an object, or a part of one.
struct ShardBytes {
  std::shared_ptr<ZarrObject> object;
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
  std::string shown;  ///< messages begin with it
};

struct OpenShard {
  std::string key;
  std::shared_ptr<ZarrObject> object;  ///< nullptr: it is a part of one
  std::vector<ShardPlace> places;      ///< in the object
};

/// Those of one level. Thread-safe.
class OpenShards {
 public:
  /// What shards are; those that are parts don't hold their objects open, which the shards around them do.
  enum class Kind { objects, parts };

  /// Keeps those that were asked for last: as many as a sixteenth of `memory` bytes has room for, at most
  /// kMostOpenShards. `chunks` lie in each. Throws Error(usage), beginning with `where`, where one index takes
  /// more than that.
  OpenShards(Kind kind, const ZarrSharding& sharding, std::uint64_t chunks, std::uint64_t memory,
             const std::string& where);

  static constexpr std::size_t kMostOpenShards = 64;

  std::uint64_t working_bytes() const { return most_ * index_bytes_ * 2; }

  /// The shard `key`, which open() opens where it is not kept. Throws what parse_shard_index throws, and Error(input)
  /// where the shard is shorter than its index.
  std::shared_ptr<const OpenShard> get(const std::string& key, const std::function<ShardBytes()>& open);

 private:
  std::shared_ptr<OpenShard> load(const std::string& key, ShardBytes shard) const;

  Kind kind_;
  ZarrSharding sharding_;
  std::uint64_t index_bytes_;
  std::size_t most_;
  std::mutex mutex_;
  std::list<std::shared_ptr<const OpenShard>> kept_;  ///< the one asked for last is first
};

}  // namespace weir
