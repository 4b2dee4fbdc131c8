#include "ingest/zarr/storage/zarr_chunks.h"

#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/files/file_state.h"

namespace weir {

ZarrChunks::ZarrChunks(ChunkObjects objects, ZarrArray array, ChunkGeometry geometry, std::uint64_t memory,
                       const std::atomic<bool>* cancel)
    : objects_(std::move(objects)), array_(std::move(array)), geometry_(std::move(geometry)) {
  for (std::size_t level = 0; level < array_.shards.size(); ++level) {
    shards_.push_back(std::make_unique<OpenShards>(array_.shards[level], geometry_.chunks_in_shards()[level], memory,
                                                   objects_.store.shown(objects_.array_key)));
  }
  scan_ = scan_objects(objects_, geometry_, memory, cancel);
}

std::uint64_t ZarrChunks::working_bytes() const {
  std::uint64_t bytes = scan_.stored.size() / 8 + objects_.store.held_bytes();
  for (const auto& level : shards_) bytes += level->working_bytes();
  return bytes;
}

std::unique_ptr<ZarrObject> ZarrChunks::open_unchanged(const std::string& key) const {
  const std::string file = objects_.store.file_of(key);
  const auto state = objects_.store.look(key);
  auto object = state ? objects_.store.open(key) : nullptr;
  if (!object) throw changed_error(file, "it is not there any more");
  if (state->ctime_ns > scan_.ctime_ns) throw changed_error(file, "it was written to after its array was opened");
  return object;
}

std::shared_ptr<OpenShard> ZarrChunks::open_shard(const std::string& key, const ChunkPlace& place) {
  std::string shown = objects_.store.shown(key);
  std::shared_ptr<OpenShard> shard = shards_.front()->get(key, shown, [&] {
    std::shared_ptr<ZarrObject> object = open_unchanged(key);
    const std::uint64_t bytes = object->size();
    return ShardBytes{std::move(object), 0, bytes};
  });
  std::string path = key;
  for (std::size_t level = 1; level < shards_.size(); ++level) {
    const std::size_t inner = place.inner[level - 1];
    const ShardPlace& at = shard->places[inner];
    if (!at.stored()) return nullptr;
    path += cat('#', inner);
    shown += cat(": chunk ", inner, " of the shard");
    shard = shards_[level]->get(path, shown, [&] { return ShardBytes{shard->object, at.offset, at.bytes}; });
  }
  return shard;
}

UnstoredChunks ZarrChunks::count_unstored() {
  UnstoredChunks unstored;
  const auto note = [&](const Index3& chunk) {
    if (unstored.count++ > 0) return;
    const ChunkPlace place = geometry_.place_of(chunk);
    unstored.first =
        cat(objects_.store.shown(objects_.key_of(place.object)), ": chunk at ", position_text(place.corner));
  };
  for (std::size_t i = 0; i < scan_.stored.size(); ++i) {
    const Index3 object = index_at(static_cast<std::int64_t>(i), geometry_.objects());
    const Box chunks = geometry_.chunks_of(object);
    unstored.all += static_cast<std::uint64_t>(chunks.voxels());
    if (scan_.stored[i] && shards_.empty()) continue;
    if (!scan_.stored[i]) {
      note(chunks.lo);
      unstored.count += static_cast<std::uint64_t>(chunks.voxels()) - 1;
      continue;
    }
    const std::string key = objects_.key_of(geometry_.object_position(object));
    for (std::int64_t k = 0; k < chunks.voxels(); ++k) {
      const Index3 chunk = chunks.lo + index_at(k, chunks.extent());
      const ChunkPlace place = geometry_.place_of(chunk);
      const auto shard = open_shard(key, place);
      if (!shard || !shard->places[place.inner.back()].stored()) note(chunk);
    }
  }
  return unstored;
}

Error ZarrChunks::wrong_chunk(const ChunkPlace& place, const Message& what) const {
  return input_error(objects_.store.shown(objects_.key_of(place.object)),
                     compose("chunk at ", position_text(place.corner), ": ", what, "; the file is damaged"));
}

std::optional<std::size_t> ZarrChunks::fetch(const ChunkPlace& place, std::span<std::byte> into) {
  const std::string key = objects_.key_of(place.object);
  const auto checked = [&](std::uint64_t bytes) {
    if (bytes <= into.size()) return static_cast<std::size_t>(bytes);
    throw wrong_chunk(place, cat("takes ", bytes, " bytes, and at most ", into.size(), " can be right"));
  };
  if (shards_.empty()) {
    const auto object = open_unchanged(key);
    const std::size_t bytes = checked(object->size());
    object->read(0, into.first(bytes));
    return bytes;
  }
  const auto shard = open_shard(key, place);
  if (!shard) return std::nullopt;
  const ShardPlace& at = shard->places[place.inner.back()];
  if (!at.stored()) return std::nullopt;
  const std::size_t bytes = checked(at.bytes);
  shard->object->read(at.offset, into.first(bytes));
  return bytes;
}

std::span<const std::byte> ZarrChunks::decode(const Index3& chunk, ChunkScratch& scratch) {
  if (!scan_.has(geometry_, geometry_.object_of(chunk))) return {};
  const ChunkPlace place = geometry_.place_of(chunk);
  const auto bytes = fetch(place, scratch.buffer.bytes());
  if (!bytes) return {};
  bytes_read_ += *bytes;
  try {
    return decode_chunk(array_.values(), geometry_.unit_shape(), *bytes, scratch).subspan(geometry_.first_byte());
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    throw wrong_chunk(place, error.message());
  }
}

}  // namespace weir
