#include "compressor/survey/leaf_cache.h"

#include <algorithm>
#include <limits>
#include <new>

#include "format/base/error.h"
#include "ingest/plan/for_pieces.h"

namespace weir {
namespace {

constexpr std::uint64_t kLeafBytes = std::uint64_t{kLeafVoxels} * sizeof(float);

std::size_t places_in(std::uint64_t bytes, std::uint64_t index) {
  const std::uint64_t places = bytes > index ? (bytes - index) / kLeafBytes : 0;
  return std::min<std::uint64_t>(places, std::numeric_limits<std::uint32_t>::max() - 2);
}

}  // namespace

LeafCache::LeafCache(const NodeLattice& leaves, std::uint64_t bytes)
    : leaves_(leaves),
      values_(places_in(std::min(bytes, whole_bytes(leaves)), index_bytes(leaves)) * kLeafBytes),
      entries_(static_cast<std::size_t>(values_.bytes().empty() ? 0 : leaves.size())),
      places_(values_.bytes().size() / kLeafBytes) {}

std::unique_ptr<LeafCache> LeafCache::where_there_is_room(const NodeLattice& leaves, std::uint64_t bytes) {
  try {
    return std::make_unique<LeafCache>(leaves, bytes);
  } catch (const Error&) {
    return nullptr;
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

std::uint64_t LeafCache::index_bytes(const NodeLattice& leaves) {
  return static_cast<std::uint64_t>(leaves.size()) * sizeof(Entry);
}

std::uint64_t LeafCache::whole_bytes(const NodeLattice& leaves) {
  return index_bytes(leaves) + static_cast<std::uint64_t>(leaves.size()) * kLeafBytes;
}

void LeafCache::add(std::int64_t leaf, std::span<const float> values, bool uniform) {
  if (entries_.empty()) return;
  Entry& entry = entries_[static_cast<std::size_t>(leaf)];
  if (uniform) {
    entry = {kUniform, values.front()};
    return;
  }
  if (taken_.load(std::memory_order_relaxed) >= places_) return;
  const std::size_t place = taken_.fetch_add(1, std::memory_order_relaxed);
  if (place >= places_) return;
  std::copy(values.begin(), values.end(), values_.floats().begin() + static_cast<std::ptrdiff_t>(place * kLeafVoxels));
  entry.place = static_cast<std::uint32_t>(place) + kFirst;
}

std::span<const float> LeafCache::leaf(const Box& inside, std::array<float, kLeafVoxels>& room) const {
  const auto count = static_cast<std::size_t>(inside.voxels());
  const Index3 at = floor_div(inside.lo, kLeafDim) - leaves_.first;
  const Entry& entry = entries_[static_cast<std::size_t>(leaves_.linear(at))];
  if (entry.place == kUniform) {
    std::fill_n(room.begin(), count, entry.value);
    return std::span<const float>(room).first(count);
  }
  return values_.floats().subspan((entry.place - kFirst) * kLeafVoxels, count);
}

bool LeafCache::has(const Box& voxels) const {
  if (entries_.empty()) return false;
  const Box under = leaves_.positions(voxels);
  for (std::int64_t z = under.lo.z; z < under.hi.z; ++z) {
    for (std::int64_t y = under.lo.y; y < under.hi.y; ++y) {
      const auto row = entries_.begin() + leaves_.linear({under.lo.x, y, z});
      if (std::any_of(row, row + under.extent().x, [](const Entry& entry) { return entry.place == kNone; })) {
        return false;
      }
    }
  }
  return true;
}

void LeafCache::copy(const Box& voxels, std::span<float> values, std::size_t threads) const {
  const Box under = leaves_.positions(voxels);
  const Index3 extent = under.extent();
  for_pieces(extent.y * extent.z, threads, [&](std::int64_t i) {
    for (std::int64_t x = under.lo.x; x < under.hi.x; ++x) {
      copy_leaf({x, under.lo.y + i % extent.y, under.lo.z + i / extent.y}, voxels, values);
    }
  });
}

void LeafCache::copy_leaf(const Index3& leaf, const Box& voxels, std::span<float> values) const {
  const Box inside = leaves_.voxels(leaf);
  const Box part = intersect(inside, voxels);
  std::array<float, kLeafVoxels> room;
  const std::span<const float> kept = this->leaf(inside, room);
  const auto length = static_cast<std::size_t>(part.extent().x);
  for (std::int64_t z = part.lo.z; z < part.hi.z; ++z) {
    for (std::int64_t y = part.lo.y; y < part.hi.y; ++y) {
      const Index3 first{part.lo.x, y, z};
      std::copy_n(kept.data() + linear_index(first - inside.lo, inside.extent()), length,
                  values.data() + linear_index(first - voxels.lo, voxels.extent()));
    }
  }
}

}  // namespace weir
