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
    shards_.push_back(std::make_unique<OpenShards>(level == 0 ? OpenShards::Kind::objects : OpenShards::Kind::parts,
                                                   array_.shards[level], geometry_.chunks_in_shards()[level], memory,
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

std::shared_ptr<const OpenShard> ZarrChunks::outer_shard(const std::string& key) {
  return shards_.front()->get(key, [&] {
    std::shared_ptr<ZarrObject> object = open_unchanged(key);
    const std::uint64_t bytes = object->size();
    return ShardBytes{std::move(object), 0, bytes, objects_.store.shown(key)};
  });
}

std::shared_ptr<const OpenShard> ZarrChunks::inner_shard(const OpenShard& outer, const OpenShard& around,
                                                         std::span<const std::size_t> path) {
  const ShardPlace& at = around.places[path.back()];
  if (!at.stored()) return nullptr;
  return shards_[path.size()]->get(cat(around.key, '#', path.back()), [&] {
    std::string shown = objects_.store.shown(outer.key);
    for (const std::size_t inner : path) shown += cat(": chunk ", inner, " of the shard");
    return ShardBytes{outer.object, at.offset, at.bytes, std::move(shown)};
  });
}

std::string ZarrChunks::corner_text(const ChunkPlace& place) const {
  return position_text({place.corner.begin() + static_cast<std::ptrdiff_t>(objects_.keys.unnamed), place.corner.end()});
}

void ZarrChunks::add_unstored(const Box& chunks, UnstoredChunks& unstored) const {
  if (unstored.count == 0) {
    const ChunkPlace place = geometry_.place_of(chunks.lo);
    unstored.first = cat(objects_.store.shown(objects_.key_of(place.object)), ": chunk at ", corner_text(place));
  }
  unstored.count += static_cast<std::uint64_t>(chunks.voxels());
}

// Counts shard by shard, so that each inner shard is opened only once for all chunks in it.
void ZarrChunks::count_unstored_in(const OpenShard& outer, const OpenShard& around, const Box& chunks,
                                   std::vector<std::size_t>& path, UnstoredChunks& unstored) {
  const std::size_t level = path.size();
  const Index3 units = geometry_.units_in_shard(level);
  const auto first = [](std::int64_t lo, std::int64_t unit) { return lo - lo % unit; };
  for (std::int64_t z = first(chunks.lo.z, units.z); z < chunks.hi.z; z += units.z) {
    for (std::int64_t y = first(chunks.lo.y, units.y); y < chunks.hi.y; y += units.y) {
      for (std::int64_t x = first(chunks.lo.x, units.x); x < chunks.hi.x; x += units.x) {
        const Index3 lo{x, y, z};
        const Box inside = intersect({lo, lo + units}, chunks);
        const std::size_t place = geometry_.place_in_shard(inside.lo, level);
        if (!around.places[place].stored()) {
          add_unstored(inside, unstored);
        } else if (level + 1 < shards_.size()) {
          path.push_back(place);
          count_unstored_in(outer, *inner_shard(outer, around, path), inside, path, unstored);
          path.pop_back();
        }
      }
    }
  }
}

UnstoredChunks ZarrChunks::count_unstored(const Box& voxels) {
  const Box wanted = geometry_.chunks_at(voxels);
  UnstoredChunks unstored;
  std::vector<std::size_t> path;
  for (std::size_t i = 0; i < scan_.stored.size(); ++i) {
    const Index3 object = index_at(static_cast<std::int64_t>(i), geometry_.objects());
    const Box chunks = intersect(geometry_.chunks_of(object), wanted);
    if (chunks.empty()) continue;
    unstored.all += static_cast<std::uint64_t>(chunks.voxels());
    if (!scan_.stored[i]) {
      add_unstored(chunks, unstored);
    } else if (!shards_.empty()) {
      const auto outer = outer_shard(objects_.key_of(geometry_.object_position(object)));
      count_unstored_in(*outer, *outer, chunks, path, unstored);
    }
  }
  return unstored;
}

Error ZarrChunks::wrong_chunk(const ChunkPlace& place, const Message& what) const {
  return input_error(objects_.store.shown(objects_.key_of(place.object)),
                     compose("chunk at ", corner_text(place), ": ", what, "; the file is damaged"));
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
  const auto outer = outer_shard(key);
  auto shard = outer;
  for (std::size_t level = 1; shard && level < shards_.size(); ++level) {
    shard = inner_shard(*outer, *shard, std::span(place.inner).first(level));
  }
  if (!shard) return std::nullopt;
  const ShardPlace& at = shard->places[place.inner.back()];
  if (!at.stored()) return std::nullopt;
  const std::size_t bytes = checked(at.bytes);
  outer->object->read(at.offset, into.first(bytes));
  return bytes;
}

std::span<const std::byte> ZarrChunks::decode(const Index3& chunk, ChunkScratch& scratch) {
  const std::span<const std::byte> bytes = decode_whole(chunk, scratch);
  return bytes.empty() ? bytes : bytes.subspan(geometry_.first_byte());
}

std::span<const std::byte> ZarrChunks::decode_whole(const Index3& chunk, ChunkScratch& scratch) {
  if (!scan_.has(geometry_, geometry_.object_of(chunk))) return {};
  const ChunkPlace place = geometry_.place_of(chunk);
  const auto bytes = fetch(place, scratch.buffer.bytes());
  if (!bytes) return {};
  bytes_read_ += *bytes;
  try {
    return decode_chunk(array_.values(), geometry_.unit_shape(), *bytes, scratch);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    throw wrong_chunk(place, error.message());
  }
}

}  // namespace weir
