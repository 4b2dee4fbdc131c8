#include "ingest/zarr/storage/open_shards.h"

#include <algorithm>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::uint64_t kIndexShare = 16;  // of --memory
constexpr std::uint64_t kIndexCopies = 2;  // the index as it is stored, and its places

}  // namespace

OpenShards::OpenShards(Kind kind, const ZarrSharding& sharding, std::uint64_t chunks, std::uint64_t memory,
                       const std::string& where)
    : kind_(kind), sharding_(sharding), index_bytes_(shard_index_bytes(sharding, chunks)) {
  const std::uint64_t room = memory / kIndexShare;
  const std::uint64_t one = kIndexCopies * index_bytes_;
  if (one > room) {
    throw usage_error(compose(where, ": the index of one of its shards of ", chunks, " chunks takes ",
                              format_bytes(one), ", more than a sixteenth of ", option("memory", format_bytes(memory)),
                              "; give at least ", (kIndexShare * one >> 20U) + 1, "MiB"));
  }
  most_ = static_cast<std::size_t>(std::min<std::uint64_t>(room / one, kMostOpenShards));
}

std::shared_ptr<OpenShard> OpenShards::load(const std::string& key, ShardBytes shard) const {
  if (shard.bytes < index_bytes_) {
    throw input_error(shard.shown, cat("has ", shard.bytes, " bytes, and the index of its shard alone takes ",
                                       index_bytes_, "; the file is cut short or damaged"));
  }
  std::vector<std::byte> index(static_cast<std::size_t>(index_bytes_));
  shard.object->read(shard.offset + (sharding_.index_first ? 0 : shard.bytes - index_bytes_), index);
  auto open = std::make_shared<OpenShard>();
  open->key = key;
  open->places = parse_shard_index(sharding_, index, shard.bytes, shard.shown);
  for (ShardPlace& place : open->places) {
    if (place.stored()) place.offset += shard.offset;
  }
  if (kind_ == Kind::objects) open->object = std::move(shard.object);
  return open;
}

std::shared_ptr<const OpenShard> OpenShards::get(const std::string& key, const std::function<ShardBytes()>& open) {
  // The lock is held while an index is read, so that threads that want the same shard wait for it. Reading an index
  // is quick.
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const auto& shard) { return shard->key == key; });
  if (found != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, found);
    return kept_.front();
  }
  kept_.push_front(load(key, open()));
  if (kept_.size() > most_) kept_.pop_back();
  return kept_.front();
}

}  // namespace weir
