#include "gpu/volume/leaf_table.h"

#include <bit>
#include <limits>

#include "format/base/error.h"
#include "format/base/text.h"
#include "gpu/math/narrow.h"

namespace weir {

namespace {

// 10^12 voxels are 2 * 10^9 blocks; local voxel coordinates stay far inside 32 bits.
constexpr std::int64_t kMaxBlocks = std::int64_t{1} << 31;
constexpr std::int64_t kMaxExtent = std::int64_t{1} << 30;
constexpr std::uint64_t kMaxEntry = std::numeric_limits<std::uint32_t>::max();

}  // namespace

NodeLattice leaf_lattice(const Box& domain) {
  if (domain.empty()) throw Error(ErrorKind::input, "the grid has no active voxel; nothing to render");
  const Index3 e = domain.extent();
  const std::string extent = cat(e.x, " x ", e.y, " x ", e.z);
  if (e.x > kMaxExtent || e.y > kMaxExtent || e.z > kMaxExtent) {
    throw Error(ErrorKind::input, cat("the grid's bounding box is ", extent, " voxels, at most 2^30 an axis render"));
  }
  const NodeLattice lattice = make_lattice(domain, kLeafDim);
  // Three axes of 2^27 blocks overflow 64 bits, so compare by division.
  if (lattice.count.x > kMaxBlocks / lattice.count.y / lattice.count.z) {
    throw Error(ErrorKind::input,
                compose("the grid's bounding box is ", extent, " voxels, more than 2^31 blocks of 8^3;",
                        " convert a part of it with ", option("roi")));
  }
  return lattice;
}

void check_entry_range(std::uint64_t tiles, std::uint64_t units) {
  if (tiles > kMaxEntry / 2) {
    throw Error(ErrorKind::input,
                compose("the grid has more than 2^31 value tiles; convert a part of it with ", option("roi")));
  }
  if (units + tiles > kMaxEntry) {
    throw Error(ErrorKind::input, cat("the grid's leaves span ", format_bytes(units * nvdb::kAlignment),
                                      ", more than a 32-bit table of 32-byte units holds; convert to a smaller size"));
  }
}

std::uint64_t most_packed_tiles(const PackedData& packed) {
  return static_cast<std::uint64_t>(packed.regions().size()) + 1;
}

LeafTable::LeafTable(const NvdbGrid& grid, CodedBlocks coded) : lattice_(leaf_lattice(grid.index_bbox())) {
  // Entry 0 is the background. calloc's untouched pages cost nothing in the empty parts of a sparse grid.
  entries_.reset(
      static_cast<std::uint32_t*>(std::calloc(static_cast<std::size_t>(lattice_.size()), sizeof(std::uint32_t))));
  if (!entries_) throw std::bad_alloc();

  add_tiles(grid);
  const std::byte* leaves = nullptr;
  if (grid.packed() == nullptr) {
    leaves = add_stored(grid);
  } else if (coded == CodedBlocks::decoded) {
    leaves = add_decoded(grid);
  } else {
    mark_coded(grid);
  }
  view_ = {.entries = entries_.get(),
           .tile_values = tile_values_.data(),
           .leaves = leaves,
           .count = narrow(lattice_.count),
           .shift = narrow(lattice_.domain.lo - lattice_.first * kLeafDim),
           .extent = narrow(lattice_.domain.extent()),
           .tile_count = static_cast<std::uint32_t>(tile_values_.size()),
           .type = grid.type()};
}

// Consecutive tiles of one value share an entry. The blocks without a stream of a packed region are such tiles.
void LeafTable::add_tiles(const NvdbGrid& grid) {
  if (grid.packed() != nullptr) tile_values_.reserve(most_packed_tiles(*grid.packed()));
  tile_values_.push_back(grid.background());
  const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
  grid.for_each_block([&](const GridBlock& block) {
    if (block.coded() || bits(block.value) == bits(grid.background())) return;
    if (bits(block.value) != bits(tile_values_.back())) tile_values_.push_back(block.value);
    add(block, static_cast<std::uint32_t>(tile_values_.size() - 1));
  });
}

void LeafTable::mark_coded(const NvdbGrid& grid) {
  check_entry_range(tile_values_.size(), 1);
  grid.for_each_block([&](const GridBlock& block) {
    if (block.coded()) add(block, static_cast<std::uint32_t>(tile_values_.size()));
  });
}

const std::byte* LeafTable::add_stored(const NvdbGrid& grid) {
  const std::byte* first = nullptr;
  const std::byte* last = nullptr;
  grid.for_each_block([&](const GridBlock& block) {
    if (block.leaf == nullptr) return;
    if (first == nullptr || block.leaf < first) first = block.leaf;
    if (last == nullptr || block.leaf > last) last = block.leaf;
  });
  check_entry_range(tile_values_.size(),
                    first == nullptr ? 0 : static_cast<std::uint64_t>(last - first) / nvdb::kAlignment);
  if (first == nullptr) return nullptr;
  const auto tiles = static_cast<std::uint32_t>(tile_values_.size());
  grid.for_each_block([&](const GridBlock& block) {
    if (block.leaf == nullptr) return;
    add(block, tiles + static_cast<std::uint32_t>(static_cast<std::uint64_t>(block.leaf - first) / nvdb::kAlignment));
  });
  return first;
}

const std::byte* LeafTable::add_decoded(const NvdbGrid& grid) {
  decoded_ = DecodedLeaves(grid);
  check_entry_range(tile_values_.size(), decoded_.bytes() / nvdb::kAlignment);
  const auto tiles = static_cast<std::uint32_t>(tile_values_.size());
  decoded_.for_each(grid, [&](const GridBlock& block, std::uint64_t number) {
    add(block, tiles + static_cast<std::uint32_t>(number * nvdb::kFloatLeafBytes / nvdb::kAlignment));
  });
  return decoded_.data();
}

// Tiles of 128 or 4096 voxels cover many blocks. The part outside the domain is never looked up.
void LeafTable::add(const GridBlock& block, std::uint32_t entry) {
  const Box all{{0, 0, 0}, lattice_.count};
  const Index3 lo = floor_div(block.origin, kLeafDim) - lattice_.first;
  const std::int64_t n = block.dim / kLeafDim;
  const Box covered = intersect({lo, lo + Index3{n, n, n}}, all);
  for (std::int64_t z = covered.lo.z; z < covered.hi.z; ++z) {
    for (std::int64_t y = covered.lo.y; y < covered.hi.y; ++y) {
      for (std::int64_t x = covered.lo.x; x < covered.hi.x; ++x) {
        entries_[static_cast<std::size_t>(lattice_.linear({x, y, z}))] = entry;
      }
    }
  }
}

std::uint64_t LeafTable::bytes() const {
  return static_cast<std::uint64_t>(lattice_.size()) * sizeof(std::uint32_t) + tile_values_.size() * sizeof(float) +
         decoded_.bytes();
}

}  // namespace weir
