#include "compressor/leaf/leaf_in_block.h"

#include <cstddef>

#include "ingest/plan/block_parts.h"
#include "ingest/source/held_leaves.h"

namespace weir {

LeafInBlock leaf_in_block(const Block& block, const Box& inside, LeafRoom& room) {
  if (block.held != nullptr) return {block.held->leaf(inside, room.values), inside, {}};
  if (block.parts == nullptr) return {block.values, block.voxels, {}};
  const Index3 by = block.parts->gather(block.values, inside, room.distinct);
  const auto count = static_cast<std::size_t>(inside.voxels());
  const auto distinct = std::span<const float>(room.distinct).first(count / static_cast<std::size_t>(volume(by)));
  if (distinct.size() == count) return {distinct, inside, {}};
  repeat_values(room.distinct.data(), by, inside.extent(), room.values.data());
  return {std::span<const float>(room.values).first(count), inside, distinct, by};
}

}  // namespace weir
