// Where the voxels of a grid on the device are: one entry per 8^3 block. A single load gives everything except the
// voxel's own bits. A leaf table (gpu/volume/leaf_table.h) has 4 bytes per block and looks up tiles and quantisation
// elsewhere. For a device, loads that wait for each other cost more than wide loads.
#pragma once

#include "gpu/volume/volume_sampler.h"

namespace weir {

/// A block of float32 voxels: a leaf, or one value everywhere.
struct alignas(8) FloatBlock {
  std::uint32_t units = 0;  ///< offset of the leaf from the grid's start, in units of 32 bytes; 0: `value` everywhere
  float value = 0;

  WEIR_HOST_DEVICE static FloatBlock of_tile(float value) { return {0, value}; }
  WEIR_HOST_DEVICE static FloatBlock of_leaf(GridType, const std::byte*, std::uint32_t units) { return {units, 0}; }
  WEIR_HOST_DEVICE float tile_value() const { return value; }
  /// Returns voxel (x<<6 | y<<3 | z) of a leaf.
  WEIR_HOST_DEVICE float leaf_voxel(const std::byte* leaf, std::uint32_t i) const {
    return load<float>(leaf + nvdb::leaf::kValues + sizeof(float) * static_cast<std::size_t>(i));
  }
};

/// A block of quantised voxels of any width.
struct alignas(16) QuantisedBlock {
  std::uint32_t units = 0;      ///< as in FloatBlock
  std::uint32_t bits_log2 = 0;  ///< log2 of the bits of a code
  float minimum = 0;            ///< of the leaf, or the tile's value
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

/// The table as kernels use it, with pointers to device memory. Voxel coordinates are local: 0 is the lowest voxel of
/// the domain.
template <class Block>
struct BlockTable {
  const Block* blocks = nullptr;      ///< count.x * count.y * count.z, x fastest; at most 2^31
  const std::byte* leaves = nullptr;  ///< the grid's start
  Int3 count;                         ///< blocks along each axis
  Int3 shift;                         ///< local + shift = voxels from the first block's corner, in [0, 8)
  Int3 extent;                        ///< voxels of the domain

  /// Returns the position of block `b`, 0 <= b < count.
  WEIR_HOST_DEVICE std::uint32_t index(const Int3& b) const { return table_index(b, count); }
  WEIR_HOST_DEVICE float value(const Block& block, std::uint32_t i) const {
    if (block.units == 0) return block.tile_value();
    return block.leaf_voxel(leaves + 32 * static_cast<std::size_t>(block.units), i);
  }

  /// Returns the value of the local voxel `i`, 0 <= i < extent.
  WEIR_HOST_DEVICE float voxel(const Int3& i) const {
    const Int3 v{i.x + shift.x, i.y + shift.y, i.z + shift.z};
    const Block block = blocks[index({v.x >> 3, v.y >> 3, v.z >> 3})];
    return value(block, LeafTableView::offset_in_leaf(v));
  }

  /// Does what LeafTableView::taps() does. All eight look-ups run the same code wherever they lie, so that the
  /// threads of a warp stay together and the loads overlap.
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
