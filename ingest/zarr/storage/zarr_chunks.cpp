#include "ingest/zarr/storage/zarr_chunks.h"

#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/files/file_state.h"

namespace weir {

ZarrChunks::ZarrChunks(ChunkObjects objects, ZarrArray array, ChunkGeometry geometry, std::uint64_t memory,
                       const std::atomic<bool>* cancel)
    : objects_(std::move(objects)), array_(std::move(array)), geometry_(std::move(geometry)) {
  if (array_.sharding) {
    shards_ = std::make_unique<OpenShards>(*array_.sharding, geometry_.chunks_in_object(), memory,
                                           objects_.store.shown(objects_.array_key));
  }
  scan_ = scan_objects(objects_, geometry_, memory, cancel);
}

std::uint64_t ZarrChunks::working_bytes() const {
  return scan_.stored.size() / 8 + objects_.store.held_bytes() + (shards_ ? shards_->working_bytes() : 0);
}

std::unique_ptr<ZarrObject> ZarrChunks::open_unchanged(const std::string& key) const {
  const std::string file = objects_.store.file_of(key);
  const auto state = objects_.store.look(key);
  auto object = state ? objects_.store.open(key) : nullptr;
  if (!object) throw changed_error(file, "it is not there any more");
  if (state->ctime_ns > scan_.ctime_ns) throw changed_error(file, "it was written to after its array was opened");
  return object;
}

std::shared_ptr<OpenShard> ZarrChunks::open_shard(const std::string& key) {
  return shards_->get(key, objects_.store.shown(key), [&] { return open_unchanged(key); });
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
    if (scan_.stored[i] && !shards_) continue;
    if (!scan_.stored[i]) {
      note(chunks.lo);
      unstored.count += static_cast<std::uint64_t>(chunks.voxels()) - 1;
      continue;
    }
    const auto shard = open_shard(objects_.key_of(geometry_.object_position(object)));
    for (std::int64_t k = 0; k < chunks.voxels(); ++k) {
      const Index3 chunk = chunks.lo + index_at(k, chunks.extent());
      if (!shard->places[geometry_.place_of(chunk).inner].stored()) note(chunk);
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
  if (!shards_) {
    const auto object = open_unchanged(key);
    const std::size_t bytes = checked(object->size());
    object->read(0, into.first(bytes));
    return bytes;
  }
  const auto shard = open_shard(key);
  const ShardPlace& at = shard->places[place.inner];
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
