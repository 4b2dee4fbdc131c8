#include "compressor/leaf/leaf_in_block.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

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

std::span<const float> copy_leaf(std::span<const float> values, const Box& voxels, const Box& inside,
                                 std::int64_t ahead, std::array<float, kLeafVoxels>& own) {
  const Index3 extent = inside.extent();
  const Index3 rows = voxels.extent();
  const float* const corner = values.data() + linear_index(inside.lo - voxels.lo, rows);
  float* out = own.data();
  for (std::int64_t z = 0; z < extent.z; ++z) {
    for (std::int64_t y = 0; y < extent.y; ++y, out += extent.x) {
      const float* const row = corner + rows.x * (y + rows.y * z);
      __builtin_prefetch(row + ahead);
      if (extent.x == kLeafDim) {  // the compiler knows this length
        std::memcpy(out, row, kLeafDim * sizeof(float));
      } else {
        std::copy_n(row, extent.x, out);
      }
    }
  }
  return {own.data(), static_cast<std::size_t>(volume(extent))};
}

}  // namespace weir
