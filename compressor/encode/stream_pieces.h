// The pieces that the encode pass writes for a region of a packed file, in their order: the streams, and before the
// first stream of each group the ends of the group's streams.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compressor/encode/layer_encoder.h"
#include "format/base/little_endian.h"
#include "format/packed/packed_layout.h"

namespace weir {

/// The place of a kept leaf.
struct KeptPlace {
  const StreamPlaces& places;
  std::size_t position;
  std::uint64_t offset;   ///< offset of the leaf's stream in the file
  std::uint64_t ordinal;  ///< ordinal of the leaf's record
};

/// Returns the offset of a region's chunk in the file.
inline std::uint64_t chunk_offset(const EncodeTarget& target, std::int64_t region_index) {
  const std::vector<Region>& regions = target.tree.regions;
  return target.layout.packed_data + packed::chunks_offset(regions.size()) +
         regions[static_cast<std::size_t>(region_index)].first_byte;
}

/// Calls visit(leaf, place) for each kept leaf of layer `x` of a region, as far as the leaves lie in `box`. Before the
/// first kept leaf of a group, calls ends(offset, bytes) with the ends of the group's streams.
template <typename Ends, typename Visit>
void for_each_kept_stream(const EncodeTarget& target, std::int64_t region_index, const StreamPlaces& places,
                          const Box& box, std::int64_t x, const Ends& ends, const Visit& visit) {
  using packed::chunk::kGroupBlocks;
  const TreeRegions& tree = target.tree;
  const Region& region = tree.regions[static_cast<std::size_t>(region_index)];
  const std::uint64_t chunk = chunk_offset(target, region_index);
  for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
    for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
      const Index3 leaf{x, y, z};
      const std::size_t position = tree.mask_position(leaf);
      if (!places.kept(position)) continue;
      const std::size_t group = position / kGroupBlocks;
      const std::size_t first = group * kGroupBlocks + static_cast<std::size_t>(std::countr_zero(places.mask(group)));
      if (position == first) {
        std::array<std::byte, 2 * kGroupBlocks> of_group{};
        std::size_t count = 0;
        for (std::size_t p = first; p < (group + 1) * kGroupBlocks; ++p) {
          if (!places.kept(p)) continue;
          store(std::span(of_group), 2 * count++,
                static_cast<std::uint16_t>(places.offset(p) + places.bytes(p) - places.base(group)));
        }
        ends(chunk + places.base(group), std::span<const std::byte>(of_group).first(2 * count));
      }
      visit(leaf,
            KeptPlace{places, position, chunk + places.offset(position), region.first_leaf + places.ordinal(position)});
    }
  }
}

/// Returns the offset in the file of the image of a corner leaf of a preview.
inline std::uint64_t corner_offset(const TreeLayout& layout, const Index3& leaf) {
  return layout.leaves + (leaf == Index3{0, 0, 0} ? 0 : nvdb::kFloatLeafBytes);
}

}  // namespace weir
