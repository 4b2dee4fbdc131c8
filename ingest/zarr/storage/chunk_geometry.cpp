#include "ingest/zarr/storage/chunk_geometry.h"

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/axes/space_axis.h"

namespace weir {
namespace {

/// Leaves room for what a chunk can grow by in its codecs: zlib counts at most 4 GiB.
constexpr std::uint64_t kLargestChunk = (std::uint64_t{1} << 32U) - (std::uint64_t{1} << 26U);

Index3 divided(const Index3& a, const Index3& b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }
Index3 times_each(const Index3& a, const Index3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
Index3 divided_up(const Index3& a, const Index3& b) {
  return {ceil_div(a.x, b.x), ceil_div(a.y, b.y), ceil_div(a.z, b.z)};
}

void check_chunk_bytes(const std::vector<std::int64_t>& elements, std::size_t value_bytes, const std::string& where) {
  std::uint64_t bytes = value_bytes;
  for (const std::int64_t e : elements) {
    if (static_cast<std::uint64_t>(e) > kLargestChunk / bytes) {
      throw input_error(where, cat("its chunks have ", position_text(elements), " elements, more than ", kLargestChunk,
                                   " bytes; write the array with smaller chunks"));
    }
    bytes *= static_cast<std::uint64_t>(e);
  }
}

/// Returns the number of chunks of `unit` elements in a shard of `chunk` elements. Throws Error(input) if it exceeds
/// kLargestChunk.
std::uint64_t count_inner(const std::vector<std::int64_t>& chunk, const std::vector<std::int64_t>& unit,
                          const std::string& where) {
  std::uint64_t count = 1;
  for (std::size_t axis = 0; axis < chunk.size(); ++axis) {
    const auto along = static_cast<std::uint64_t>(chunk[axis] / unit[axis]);
    if (along > kLargestChunk / count) {
      throw input_error(where, cat("its shards of ", position_text(chunk), " elements hold more than ", kLargestChunk,
                                   " chunks; write the array with smaller shards"));
    }
    count *= along;
  }
  return count;
}

}  // namespace

std::string position_text(const std::vector<std::int64_t>& position) {
  std::string text;
  for (const std::int64_t p : position) text += cat(text.empty() ? "" : ", ", p);
  return text;
}

ChunkGeometry::ChunkGeometry(const ZarrArray& array, const std::vector<std::int64_t>& index, const std::string& where,
                             std::optional<std::int64_t> behind)
    : chunk_(array.chunk),
      units_(array.unit()),
      index_(index),
      behind_(behind),
      unit_shape_{array.unit(), scalar_bytes(array.type)} {
  const std::size_t positions = index.size() + (behind ? 1 : 0);
  if (positions + kSpaceAxes != array.shape.size()) {
    throw Error(ErrorKind::internal, cat(where, ": ", positions, " positions for ", array.shape.size(), " axes"));
  }
  check_chunk_bytes(units_, unit_shape_.value_bytes, where);
  for (const ZarrSharding& level : array.shards) {
    chunks_in_shards_.push_back(count_inner(inner_.empty() ? chunk_ : inner_.back(), level.chunk, where));
    inner_.push_back(level.chunk);
  }
  extent_ = of_space(array.shape);
  unit_ = of_space(units_);
  object_ = of_space(chunk_);
  objects_ = divided_up(extent_, object_);
  std::size_t position = 0;
  for (std::size_t axis = 0; axis < index_.size(); ++axis) {
    position =
        position * static_cast<std::size_t>(units_[axis]) + static_cast<std::size_t>(index_[axis] % units_[axis]);
  }
  const std::size_t numbers = behind ? static_cast<std::size_t>(units_.back()) : 1;  // of a voxel
  first_byte_ = position * static_cast<std::size_t>(volume(unit_)) * numbers * unit_shape_.value_bytes;
}

Index3 ChunkGeometry::of_space(const std::vector<std::int64_t>& elements) const {
  const std::size_t first = index_.size();
  return {elements[first + 2], elements[first + 1], elements[first]};
}

std::vector<std::int64_t> ChunkGeometry::element_of(const Index3& chunk) const {
  std::vector<std::int64_t> element = index_;
  const Index3 first = times_each(chunk, unit_);
  element.insert(element.end(), {first.z, first.y, first.x});
  if (behind_) element.push_back(*behind_);
  return element;
}

std::vector<std::int64_t> ChunkGeometry::object_position(const Index3& object) const {
  std::vector<std::int64_t> position;
  for (std::size_t axis = 0; axis < index_.size(); ++axis) position.push_back(index_[axis] / chunk_[axis]);
  position.insert(position.end(), {object.z, object.y, object.x});
  if (behind_) position.push_back(*behind_ / chunk_.back());
  return position;
}

Index3 ChunkGeometry::object_of(const Index3& chunk) const { return divided(times_each(chunk, unit_), object_); }

ChunkPlace ChunkGeometry::place_of(const Index3& chunk) const {
  ChunkPlace place;
  place.object = object_position(object_of(chunk));
  const std::vector<std::int64_t> element = element_of(chunk);
  for (std::size_t axis = 0; axis < element.size(); ++axis)
    place.corner.push_back(element[axis] - element[axis] % units_[axis]);
  for (std::size_t level = 0; level < inner_.size(); ++level) place.inner.push_back(place_in_shard(chunk, level));
  return place;
}

std::size_t ChunkGeometry::place_in_shard(const Index3& chunk, std::size_t level) const {
  const std::vector<std::int64_t>& shard = level == 0 ? chunk_ : inner_[level - 1];
  const std::vector<std::int64_t>& inner = inner_[level];
  const std::vector<std::int64_t> element = element_of(chunk);
  std::size_t place = 0;
  for (std::size_t axis = 0; axis < element.size(); ++axis) {
    const std::int64_t along = element[axis] % shard[axis] / inner[axis];
    place = place * static_cast<std::size_t>(shard[axis] / inner[axis]) + static_cast<std::size_t>(along);
  }
  return place;
}

Index3 ChunkGeometry::units_in_shard(std::size_t level) const { return divided(of_space(inner_[level]), unit_); }

Box ChunkGeometry::chunks_of(const Index3& object) const {
  const Index3 lo = times_each(object, object_);
  const Index3 hi = min(lo + object_, extent_);
  return {divided(lo, unit_), divided_up(hi, unit_)};
}

Box ChunkGeometry::chunks_at(const Box& voxels) const {
  return voxels.empty() ? Box{} : Box{divided(voxels.lo, unit_), divided_up(voxels.hi, unit_)};
}

}  // namespace weir
