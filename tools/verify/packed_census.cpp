#include "tools/verify/packed_census.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <numeric>

#include "format/nanovdb/packed_blocks.h"

namespace weir {
namespace {

void count_block(const GridBlock& block, PackedCensus& census) {
  if (!block.coded()) return;
  const auto kind = static_cast<std::size_t>(packed_kind(block.stream));
  ++census.blocks[kind];
  census.bytes[kind] += block.stream.bytes;
}

PackedCensus merged_census(PackedCensus a, const PackedCensus& b) {
  for (std::size_t kind = 0; kind < kPackedKinds; ++kind) {
    a.blocks[kind] += b.blocks[kind];
    a.bytes[kind] += b.bytes[kind];
  }
  return a;
}

}  // namespace

std::uint64_t PackedCensus::coded() const { return std::accumulate(blocks.begin(), blocks.end(), std::uint64_t{0}); }

double PackedCensus::bits_a_voxel(PackedKind kind) const {
  const auto k = static_cast<std::size_t>(kind);
  if (blocks[k] == 0) return 0;
  return 8.0 * static_cast<double>(bytes[k]) / (static_cast<double>(kLeafVoxels) * static_cast<double>(blocks[k]));
}

PackedCensus take_packed_census(const PackedData& packed) {
  const NodeLattice& regions = packed.regions();
  PackedCensus census = tbb::parallel_reduce(
      tbb::blocked_range<std::int64_t>(0, regions.size()), PackedCensus{},
      [&](const tbb::blocked_range<std::int64_t>& range, PackedCensus part) {
        for (std::int64_t i = range.begin(); i < range.end(); ++i) {
          for_each_packed_block(packed, regions.position(i), [&](const GridBlock& block) { count_block(block, part); });
        }
        return part;
      },
      merged_census);
  census.none = packed_block_count(packed) - census.coded();
  census.directory_bytes =
      packed.bytes().size() - std::accumulate(census.bytes.begin(), census.bytes.end(), std::uint64_t{0});
  return census;
}

const char* packed_kind_name(PackedKind kind) {
  constexpr std::array<const char*, kPackedKinds> kNames{"mean", "transform", "lattice", "raw"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::uint64_t packed_block_count(const PackedData& packed) {
  return static_cast<std::uint64_t>(make_lattice(packed.regions().domain, kLeafDim).size());
}

}  // namespace weir
