// Where the voxels of a grid on the device are: one entry for each 8^3 block, a
// single load that says all but the voxel's own bits. A leaf table (gpu/volume/leaf_table.h)
// has 4 bytes a block and looks tiles and quantisation up elsewhere; loads that
// wait for each other cost a device more than wide ones do.
#pragma once

#include "gpu/volume/volume_sampler.h"

namespace weir {

/// A block of float32 voxels: a leaf, or one value all over.
struct alignas(8) FloatBlock {
  std::uint32_t units = 0;  ///< of 32 bytes from the grid's start to the leaf; 0: `value` all over
  float value = 0;

  WEIR_HOST_DEVICE static FloatBlock of_tile(float value) { return {0, value}; }
  WEIR_HOST_DEVICE static FloatBlock of_leaf(GridType, const std::byte*, std::uint32_t units) { return {units, 0}; }
  WEIR_HOST_DEVICE float tile_value() const { return value; }
  /// Voxel (x<<6 | y<<3 | z) of a leaf.
  WEIR_HOST_DEVICE float leaf_voxel(const std::byte* leaf, std::uint32_t i) const {
    return load<float>(leaf + nvdb::leaf::kValues + sizeof(float) * static_cast<std::size_t>(i));
  }
};

/// A block of quantised voxels, of any of the widths.
struct alignas(16) QuantisedBlock {
  std::uint32_t units = 0;      ///< as FloatBlock's
  std::uint32_t bits_log2 = 0;  ///< of a code
  float minimum = 0;            ///< or the tile's value
  float quantum = 0;

  WEIR_HOST_DEVICE static QuantisedBlock of_tile(float value) { return {0, 0, value, 0}; }
  WEIR_HOST_DEVICE static QuantisedBlock of_leaf(GridType type, const std::byte* leaf, std::uint32_t units) {
    return {units, leaf_bits_log2(type, leaf), load<float>(leaf + nvdb::leaf::kQuantMinimum),
            load<float>(leaf + nvdb::leaf::kQuantum)};
  }
  WEIR_HOST_DEVICE float tile_value() const { return minimum; }
  WEIR_HOST_DEVICE float leaf_voxel(const std::byte* leaf, std::uint32_t i) const {
    return dequantize(leaf_code(leaf + nvdb::leaf::kCodes, bits_log2, i), quantum, minimum);
  }
};

/// The table as kernels use it; pointers to device memory. Voxel coordinates are local: 0 is the lowest voxel of the
/// domain.
template <class Block>
struct BlockTable {
  const Block* blocks = nullptr;      ///< count.x * count.y * count.z, x fastest; 2^31 at most
  const std::byte* leaves = nullptr;  ///< the grid's start
  Int3 count;                         ///< blocks along each axis
  Int3 shift;                         ///< local + shift = voxels from the first block's corner, in [0, 8)
  Int3 extent;                        ///< voxels of the domain

  /// Position of a block, 0 <= b < count.
  WEIR_HOST_DEVICE std::uint32_t index(const Int3& b) const { return table_index(b, count); }
  WEIR_HOST_DEVICE float value(const Block& block, std::uint32_t i) const {
    if (block.units == 0) return block.tile_value();
    return block.leaf_voxel(leaves + 32 * static_cast<std::size_t>(block.units), i);
  }

  /// Value of the local voxel `i`, 0 <= i < extent.
  WEIR_HOST_DEVICE float voxel(const Int3& i) const {
    const Int3 v{i.x + shift.x, i.y + shift.y, i.z + shift.z};
    const Block block = blocks[index({v.x >> 3, v.y >> 3, v.z >> 3})];
    return value(block, LeafTableView::offset_in_leaf(v));
  }

  /// As LeafTableView's. All eight look-ups are made the same way wherever they lie, so that threads of a warp stay
  /// together and the loads are under way at once.
  WEIR_HOST_DEVICE bool taps(const Int3& i, float (&c)[8]) const {
    const Int3 low{i.x + shift.x, i.y + shift.y, i.z + shift.z};
    const Int3 high{upper(i.x, true, extent.x) + shift.x, upper(i.y, true, extent.y) + shift.y,
                    upper(i.z, true, extent.z) + shift.z};
    for (int k = 0; k < 8; ++k) {
      const Int3 v{(k & 1) != 0 ? high.x : low.x, (k & 2) != 0 ? high.y : low.y, (k & 4) != 0 ? high.z : low.z};
      const Block block = blocks[index({v.x >> 3, v.y >> 3, v.z >> 3})];
      c[k] = value(block, LeafTableView::offset_in_leaf(v));
    }
    return false;
  }
};

}  // namespace weir
