#include "compressor/encode/packed_writer.h"

#include <array>
#include <span>
#include <vector>

#include "format/base/little_endian.h"
#include "format/packed/packed_layout.h"

namespace weir {
namespace {

using namespace packed;

void write_entry(const TreeLayout& layout, std::int64_t index, std::uint64_t chunk, float value, std::uint32_t bytes,
                 File& out) {
  std::array<std::byte, region::kEntryBytes> entry{};
  store(std::span<std::byte>(entry), region::kChunk, chunk);
  store(std::span<std::byte>(entry), region::kValue, value);
  store(std::span<std::byte>(entry), region::kChunkBytes, bytes);
  out.write_at(layout.packed_data + kRegionsOffset + static_cast<std::uint64_t>(index) * region::kEntryBytes, entry);
}

}  // namespace

void write_packed_head(const PackedTarget& packed, const TreeRegions& tree, const TreeLayout& layout, File& out) {
  std::vector<std::byte> bytes(kRegionsOffset);
  const std::span<std::byte> head(bytes);
  const BlockConstants& c = packed.constants;
  store(head, header::kBytes, layout.counts.packed_bytes);
  store(head, header::kVersion, kVersion);
  store(head, header::kFlags, packed.rule.preview ? header::kFlagPreview : 0U);
  const Index3& first = tree.region_lattice.first;
  const Index3& count = tree.region_lattice.count;
  store(head, header::kFirstRegion,
        std::array{static_cast<std::int32_t>(first.x), static_cast<std::int32_t>(first.y),
                   static_cast<std::int32_t>(first.z)});
  store(head, header::kRegionCount,
        std::array{static_cast<std::uint32_t>(count.x), static_cast<std::uint32_t>(count.y),
                   static_cast<std::uint32_t>(count.z)});
  store(head, header::kMinimum, c.minimum);
  store(head, header::kMaximum, c.maximum);
  store(head, header::kCoarsest, c.coarsest);
  store(head, header::kLatticeMinimum, c.lattice_minimum);
  store(head, header::kLatticeQuantum, c.lattice_quantum);
  store(head, header::kLatticeBits, c.lattice_bits);
  store(head, header::kBelowOne, c.below_one);
  store(head, header::kBelowMore, c.below_more);
  store(head, header::kTables, static_cast<std::uint32_t>(kHeaderBytes));
  store(head, header::kTableCount, std::uint32_t{kPackedTables});
  store(head, header::kRegions, kRegionsOffset);
  std::memcpy(bytes.data() + kHeaderBytes, c.tables, kTablesBytes);
  out.write_at(layout.packed_data, bytes);
}

void write_empty_region(const TreeLayout& layout, std::int64_t region, float value, File& out) {
  write_entry(layout, region, 0, value, 0, out);
}

void write_directory(const TreeLayout& layout, std::size_t regions, std::int64_t index, const Region& region,
                     const StreamPlaces& places, File& out) {
  if (places.streams() == 0) return write_empty_region(layout, index, region.packed_value, out);
  const std::uint64_t at = chunks_offset(regions) + region.first_byte;
  write_entry(layout, index, at, region.packed_value, places.chunk_bytes(), out);
  std::vector<std::byte> bytes(chunk::kGroups);
  const std::span<std::byte> head(bytes);
  store(head, chunk::kMeanLow, places.plan().region.means.low);
  store(head, chunk::kMeanHigh, places.plan().region.means.high);
  for (std::size_t group = 0; group <= chunk::kGroupCount; ++group) {
    store(head, chunk::kBases + 4 * group, places.base(group));
  }
  for (std::size_t group = 0; group < chunk::kGroupCount; ++group) {
    store(head, chunk::kMasks + 2 * group, places.mask(group));
  }
  out.write_at(layout.packed_data + at, bytes);
}

}  // namespace weir
