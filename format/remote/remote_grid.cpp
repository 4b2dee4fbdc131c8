#include "format/remote/remote_grid.h"

#include <algorithm>
#include <bitset>
#include <iterator>
#include <map>
#include <mutex>
#include <utility>

#include "format/base/error.h"
#include "format/nanovdb/nvdb_bytes.h"
#include "format/nanovdb/packed_chunk.h"
#include "format/packed/packed_layout.h"
#include "format/remote/remote_head.h"
#include "format/remote/request_plan.h"

namespace weir {
namespace {

/// The most requests for the streams of a region.
constexpr std::size_t kRequestsOfRegion = 3;

constexpr auto kGroups = static_cast<std::size_t>(packed::chunk::kGroupCount);
/// From this many groups on, the whole region is read.
constexpr std::size_t kManyGroups = kGroups / 3;

/// Groups of 16 blocks along z (packed_chunk.h).
using GroupSet = std::bitset<kGroups>;

// Adds the groups that touch `box`, which lies in one region.
void add_groups(const Box& box, GroupSet& groups) {
  const NodeLattice blocks = make_lattice(box, kLeafDim);
  for (std::int64_t x = 0; x < blocks.count.x; ++x) {
    for (std::int64_t y = 0; y < blocks.count.y; ++y) {
      groups.set(packed_position(blocks.first + Index3{x, y, 0}) / packed::chunk::kGroupBlocks);
    }
  }
}

NvdbGrid open_heads(FetchedBytes& file, const std::string& path) {
  const RemoteHead head = fetch_heads(file, path);
  return NvdbGrid::of_heads(file.bytes(), path, head.header, head.tree, head.blind);
}

}  // namespace

/// The groups that are wanted of a region.
struct RemoteGrid::WantedRegion {
  PackedRegion region;
  GroupSet groups;
};

RemoteGrid::RemoteGrid(std::string path, RangeReader reader, std::uint64_t cache)
    : path_(std::move(path)),
      cache_(cache),
      file_(fetch_file_head(path_, std::move(reader))),
      grid_(open_heads(*file_, path_)) {
  const PackedData& packed = *grid_.packed();
  const auto table = static_cast<std::uint64_t>(packed.regions().size()) * packed::region::kEntryBytes;
  heads_end_ = packed.file_offset() + packed.header().table + table;
}

std::vector<RemoteGrid::WantedRegion> RemoteGrid::wanted_regions(std::span<const Box> boxes) const {
  const PackedData& packed = *grid_.packed();
  const NodeLattice& regions = packed.regions();
  std::map<std::int64_t, GroupSet> groups;
  for (const Box& box : boxes) {
    const Box inside = intersect(box, regions.domain);
    if (inside.empty()) continue;
    const NodeLattice touched = make_lattice(inside, kLowerDim);
    for_each_index({{}, touched.count}, [&](const Index3& at) {
      add_groups(touched.voxels(at), groups[regions.linear(touched.first + at - regions.first)]);
    });
  }
  std::vector<WantedRegion> wanted;
  for (const auto& [linear, set] : groups) {
    const PackedRegion region = packed.region(regions.position(linear));
    if (region.chunk != 0) wanted.push_back({region, set});
  }
  return wanted;
}

RemoteGrid::Ranges RemoteGrid::heads_of(std::span<const WantedRegion> wanted) const {
  Ranges heads;
  for (const auto& [region, groups] : wanted) {
    const std::uint64_t bytes = groups.count() >= kManyGroups ? region.bytes : packed::chunk::kGroups;
    heads.push_back({grid_.packed()->file_offset() + region.chunk, bytes});
  }
  return heads;
}

std::vector<RemoteGrid::Ranges> RemoteGrid::groups_of(std::span<const WantedRegion> wanted) const {
  const PackedData& packed = *grid_.packed();
  std::vector<Ranges> all;
  for (const auto& [region, groups] : wanted) {
    const std::uint64_t chunk = packed.file_offset() + region.chunk;
    const NvdbBytes head(packed.bytes().subspan(region.chunk, region.bytes), chunk, path_);
    Ranges& ranges = all.emplace_back();
    for (unsigned group = 0; group < kGroups; ++group) {
      if (!groups.test(group)) continue;
      const PackedGroup found = packed_group(head, region.bytes, group);
      ranges.push_back({chunk + found.begin, found.end - found.begin});
    }
  }
  return all;
}

bool RemoteGrid::has(std::span<const WantedRegion> wanted) const {
  const auto there = [this](const ByteRange& range) { return file_->has(range); };
  if (!std::ranges::all_of(heads_of(wanted), there)) return false;
  return std::ranges::all_of(groups_of(wanted),
                             [&](const Ranges& region) { return std::ranges::all_of(region, there); });
}

void RemoteGrid::fetch(std::span<const WantedRegion> wanted) {
  const Ranges heads = heads_of(wanted);
  file_->fetch(plan_requests(heads, heads.size()));
  Ranges streams;
  for (Ranges& region : groups_of(wanted)) {
    std::erase_if(region, [this](const ByteRange& range) { return file_->has(range); });
    std::ranges::copy(plan_requests(std::move(region), kRequestsOfRegion), std::back_inserter(streams));
  }
  const std::size_t most = streams.size();
  file_->fetch(plan_requests(std::move(streams), most));
}

void RemoteGrid::make_room() {
  if (file_->held() > cache_) file_->forget_from(heads_end_);
}

bool RemoteGrid::fit_cache(std::span<const Box> boxes) const {
  std::uint64_t bytes = 0;
  for (const WantedRegion& wanted : wanted_regions(boxes)) bytes += wanted.region.bytes;
  return bytes <= cache_;
}

void RemoteGrid::with_blocks(std::span<const Box> boxes, const std::function<void()>& use) {
  try {
    use_blocks(boxes, use);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::input) {
      const std::unique_lock lock(mutex_);
      file_->forget_from(heads_end_);
    }
    throw;
  }
}

void RemoteGrid::use_blocks(std::span<const Box> boxes, const std::function<void()>& use) {
  // Reads only the table of regions, which is always held.
  const std::vector<WantedRegion> wanted = wanted_regions(boxes);
  {
    const std::shared_lock lock(mutex_);
    if (has(wanted)) return use();
  }
  const std::unique_lock lock(mutex_);
  make_room();
  fetch(wanted);
  use();
}

RemoteGrid::Ranges RemoteGrid::macrocells() const {
  const auto* const first = reinterpret_cast<const std::byte*>(grid_.macrocells().cells.data());
  if (first == nullptr) return {};
  return {{static_cast<std::uint64_t>(first - file_->bytes().data()), grid_.macrocells().cells.size_bytes()}};
}

void RemoteGrid::with_macrocells(const std::function<void()>& use) {
  const std::unique_lock lock(mutex_);
  file_->fetch(macrocells());
  use();
}

}  // namespace weir
