#include "ingest/zarr/storage/gathered_chunks.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "format/io/digest.h"

namespace weir {
namespace {

/// Copies the first `width` of every `step` bytes of `from` to `to`, `room` bytes apart.
void scatter(std::span<const std::byte> from, std::size_t step, std::size_t width, std::size_t voxels, std::byte* to,
             std::size_t room) {
  for (std::size_t i = 0; i < voxels; ++i) std::memcpy(to + i * room, from.data() + i * step, width);
}

bool share_chunks(const ChunkGeometry& a, const ChunkGeometry& b) {
  return a.place_of({0, 0, 0}).corner == b.place_of({0, 0, 0}).corner;
}

bool share_objects(const ChunkGeometry& a, const ChunkGeometry& b) {
  return a.object_position({0, 0, 0}) == b.object_position({0, 0, 0});
}

VoxelParts leading_parts(const ZarrArray& array, const std::vector<std::int64_t>& index, std::int64_t count,
                         const ComponentChoice& choice, const std::string& where) {
  VoxelParts found;
  const std::int64_t first = choice.magnitude ? 0 : choice.position;
  const std::int64_t end = choice.magnitude ? count : first + 1;
  for (std::int64_t c = first; c < end; ++c) {
    std::vector<std::int64_t> position = index;
    position.push_back(c);
    found.parts.push_back({ChunkGeometry(array, position, where), 1, 1});
  }
  if (choice.magnitude) found.components = {count, choice};
  return found;
}

VoxelParts trailing_parts(const ZarrArray& array, const std::vector<std::int64_t>& index, std::int64_t count,
                          const ComponentChoice& choice, const std::string& where) {
  VoxelParts found;
  const std::int64_t unit = array.unit().back();
  const auto numbers = static_cast<std::size_t>(unit);
  if (!choice.magnitude) {
    found.parts.push_back({ChunkGeometry(array, index, where, choice.position), numbers, numbers});
    found.components = {unit, {false, choice.position % unit}};
    return found;
  }
  for (std::int64_t first = 0; first < count; first += unit) {
    const auto used = static_cast<std::size_t>(std::min(unit, count - first));
    found.parts.push_back({ChunkGeometry(array, index, where, first), numbers, used});
  }
  found.components = {count, choice};
  return found;
}

}  // namespace

std::size_t VoxelParts::gathered_bytes() const {
  if (!gathers()) return 0;
  const ChunkGeometry& geometry = parts.front().geometry;
  return static_cast<std::size_t>(volume(geometry.unit()) * components.count) * geometry.unit_shape().value_bytes;
}

VoxelParts voxel_parts(const ZarrArray& array, const std::vector<std::int64_t>& index, const ComponentAxis& axis,
                       const std::optional<ComponentChoice>& choice, const std::string& where) {
  if (!axis.found() || !choice) return {{{ChunkGeometry(array, index, where), 1, 1}}, {}};
  return axis.leading ? leading_parts(array, index, axis.count, *choice, where)
                      : trailing_parts(array, index, axis.count, *choice, where);
}

GatheredChunks::GatheredChunks(const ChunkObjects& objects, const ZarrArray& array, const VoxelParts& parts,
                               std::uint64_t memory, const std::atomic<bool>* cancel)
    : value_bytes_(scalar_bytes(array.type)),
      gathered_bytes_(parts.gathered_bytes()),
      fill_(array.fill.value_or(std::vector<std::byte>(value_bytes_))),
      store_bytes_(objects.store.held_bytes()) {
  for (const VoxelPart& part : parts.parts) {
    if (chunks_.empty() || !share_chunks(chunks_.back()->geometry(), part.geometry)) {
      chunks_.push_back(
          std::make_unique<ZarrChunks>(objects, array, part.geometry, memory / parts.parts.size(), cancel));
    }
    parts_.push_back({chunks_.size() - 1, part.geometry.first_byte(), part.numbers, part.used});
    voxel_bytes_ += part.used * value_bytes_;
  }
}

std::vector<const ZarrChunks*> GatheredChunks::of_each_object() const {
  std::vector<const ZarrChunks*> each;
  for (const auto& chunks : chunks_) {
    if (each.empty() || !share_objects(each.back()->geometry(), chunks->geometry())) each.push_back(chunks.get());
  }
  return each;
}

std::string GatheredChunks::digest() const {
  const std::vector<const ZarrChunks*> each = of_each_object();
  if (each.size() == 1) return each.front()->scan().digest;
  std::string all;
  for (const ZarrChunks* chunks : each) all += chunks->scan().digest;
  return piece_digest(std::as_bytes(std::span(all))).hex();
}

std::uint64_t GatheredChunks::object_bytes() const {
  std::uint64_t bytes = 0;
  for (const ZarrChunks* chunks : of_each_object()) bytes += chunks->scan().bytes;
  return bytes;
}

std::int64_t GatheredChunks::mtime_ns() const {
  std::int64_t newest = 0;
  for (const auto& chunks : chunks_) newest = std::max(newest, chunks->scan().mtime_ns);
  return newest;
}

std::string GatheredChunks::key_by_other_separator() const {
  const auto has_stored = [](const auto& chunks) {
    const std::vector<bool>& stored = chunks->scan().stored;
    return std::find(stored.begin(), stored.end(), true) != stored.end();
  };
  return std::any_of(chunks_.begin(), chunks_.end(), has_stored) ? "" : chunks_.front()->key_by_other_separator();
}

UnstoredChunks GatheredChunks::count_unstored(const Box& voxels) {
  UnstoredChunks sum;
  for (const auto& chunks : chunks_) {
    UnstoredChunks unstored = chunks->count_unstored(voxels);
    if (sum.first.empty()) sum.first = std::move(unstored.first);
    sum.count += unstored.count;
    sum.all += unstored.all;
  }
  return sum;
}

std::uint64_t GatheredChunks::working_bytes() const {
  std::uint64_t bytes = store_bytes_;
  for (const auto& chunks : chunks_) bytes += chunks->working_bytes() - store_bytes_;
  return bytes;
}

std::uint64_t GatheredChunks::bytes_read() const {
  std::uint64_t bytes = 0;
  for (const auto& chunks : chunks_) bytes += chunks->bytes_read();
  return bytes;
}

std::span<const std::byte> GatheredChunks::decode(const Index3& chunk, ChunkScratch& scratch) {
  if (gathered_bytes_ == 0) return chunks_.front()->decode(chunk, scratch);
  const std::span<std::byte> gathered = scratch.gathered.bytes().first(gathered_bytes_);
  const std::size_t voxels = gathered_bytes_ / voxel_bytes_;
  bool stored = false;
  std::span<const std::byte> whole;
  std::byte* to = gathered.data();
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const Part& part = parts_[p];
    if (p == 0 || part.chunks != parts_[p - 1].chunks) whole = chunks_[part.chunks]->decode_whole(chunk, scratch);
    stored = stored || !whole.empty();
    if (!whole.empty()) {
      scatter(whole.subspan(part.first_byte), part.numbers * value_bytes_, part.used * value_bytes_, voxels, to,
              voxel_bytes_);
      to += part.used * value_bytes_;
      continue;
    }
    for (std::size_t c = 0; c < part.used; ++c, to += value_bytes_) {
      scatter(fill_, 0, value_bytes_, voxels, to, voxel_bytes_);
    }
  }
  return stored ? gathered : std::span<const std::byte>();
}

}  // namespace weir
