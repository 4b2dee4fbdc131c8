// Makes NanoVDB leaves from decoded blocks. For host and device.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/expanded_tree.h"
#include "gpu/volume/block_lattice.h"

namespace weir {

/// One group of threads per leaf. Voxels outside the domain are inactive. Their value is the background, or the value
/// in the leaf's range nearest to it.
struct WriteLeaves {
  struct Shared {
    LeafStatistics statistics;
  };

  BlockLattice lattice;
  Int3 corner;  ///< of the first region: index of its lowest voxel
  float background = 0;
  bool quantised = false;  ///< true: 16 bits between each leaf's least and largest value; false: floats
  const BlockId* blocks = nullptr;
  const float* values = nullptr;         ///< 512 per block
  std::byte* leaves = nullptr;           ///< at a multiple of 32
  LeafStatistics* statistics = nullptr;  ///< one per leaf

  template <class Thread>
  WEIR_HOST_DEVICE void operator()(const Thread& thread, Shared& shared, std::uint32_t i) const {
    const Int3 block = lattice.block_at(blocks[i]);
    const Int3 low = inside(block, 0);
    const Int3 high = inside(block, 8);
    const float* const of_block = values + std::size_t{512} * i;
    const std::uint64_t bytes = quantised ? nvdb::kLeafHeadBytes + 1024 : nvdb::kFloatLeafBytes;
    std::byte* const leaf = leaves + bytes * i;
    if (thread.index() == 0) {
      shared.statistics = statistics_of(of_block, low, high);
      statistics[i] = shared.statistics;
      write_head(leaf, block, low, high, shared.statistics);
    }
    thread.meet();
    const float minimum = shared.statistics.min;
    const float quantum = quantum_of(shared.statistics);
    for (auto n = static_cast<std::int32_t>(thread.index()); n < 512; n += static_cast<std::int32_t>(thread.count())) {
      const bool active = n >> 6 >= low.x && n >> 6 < high.x && (n >> 3 & 7) >= low.y && (n >> 3 & 7) < high.y &&
                          (n & 7) >= low.z && (n & 7) < high.z;
      const float value = active ? of_block[n] : background;
      if (quantised) {
        put(leaf + nvdb::leaf::kCodes + 2 * n, in_quanta(value - minimum, quantum));
      } else {
        put(leaf + nvdb::leaf::kValues + 4 * n, value);
      }
    }
    thread.meet();
  }

 private:
  template <class T>
  WEIR_HOST_DEVICE static void put(std::byte* at, T value) {
    *reinterpret_cast<T*>(at) = value;
  }

  // Returns the block's lowest (`edge` 0) or highest (`edge` 8) voxel in the domain, relative to the block's lowest.
  WEIR_HOST_DEVICE Int3 inside(const Int3& block, std::int32_t edge) const {
    const auto along = [edge](std::int32_t b, std::int32_t shift, std::int32_t extent) {
      return clamped(edge == 0 ? shift - 8 * b : shift + extent - 8 * b, 0, 8);
    };
    return {along(block.x, lattice.shift.x, lattice.extent.x), along(block.y, lattice.shift.y, lattice.extent.y),
            along(block.z, lattice.shift.z, lattice.extent.z)};
  }

  // Uses the order and the arithmetic of NodeStatistics.
  WEIR_HOST_DEVICE static LeafStatistics statistics_of(const float* values, const Int3& low, const Int3& high) {
    LeafStatistics s{3.402823466e38F, -3.402823466e38F, 0, 0};
    double count = 0;
    for (std::int32_t x = low.x; x < high.x; ++x) {
      for (std::int32_t y = low.y; y < high.y; ++y) {
        for (std::int32_t z = low.z; z < high.z; ++z) {
          const float value = values[x << 6 | y << 3 | z];
          if (value < s.min) s.min = value;
          if (value > s.max) s.max = value;
          count += 1;
          const double delta = static_cast<double>(value) - s.mean;
          s.mean += delta / count;
          s.m2 += delta * (static_cast<double>(value) - s.mean);
        }
      }
    }
    return s;
  }

  WEIR_HOST_DEVICE static float quantum_of(const LeafStatistics& s) { return (s.max - s.min) / 65535; }
  // Returns zero if all values are equal.
  WEIR_HOST_DEVICE static std::uint16_t in_quanta(float value, float quantum) {
    if (!(quantum > 0)) return 0;
    return static_cast<std::uint16_t>(clamped(value / quantum + 0.5F, 0.0F, 65535.0F));
  }

  WEIR_HOST_DEVICE void write_head(std::byte* leaf, const Int3& block, const Int3& low, const Int3& high,
                                   const LeafStatistics& s) const {
    using namespace nvdb::leaf;
    constexpr std::uint32_t kHasBox = 2;
    put(leaf + kBBoxMin, corner.x + 8 * block.x + low.x);
    put(leaf + kBBoxMin + 4, corner.y + 8 * block.y + low.y);
    put(leaf + kBBoxMin + 8, corner.z + 8 * block.z + low.z);
    put(leaf + kBBoxDim, static_cast<std::uint32_t>(high.x - low.x - 1) |
                             static_cast<std::uint32_t>(high.y - low.y - 1) << 8U |
                             static_cast<std::uint32_t>(high.z - low.z - 1) << 16U | kHasBox << 24U);
    const std::uint64_t row =
        ((1U << static_cast<unsigned>(high.z)) - 1U) & ~((1U << static_cast<unsigned>(low.z)) - 1U);
    for (std::int32_t x = 0; x < 8; ++x) {
      std::uint64_t plane = 0;
      for (std::int32_t y = low.y; y < high.y && x >= low.x && x < high.x; ++y) plane |= row << 8 * y;
      put(leaf + kValueMask + 8 * x, plane);
    }
    const double voxels = static_cast<double>(high.x - low.x) * (high.y - low.y) * (high.z - low.z);
    const auto average = static_cast<float>(s.mean);
    const auto deviation = static_cast<float>(voxels < 2 ? 0.0 : std::sqrt(s.m2 / voxels));
    if (quantised) {
      const float quantum = quantum_of(s);
      put(leaf + kQuantMinimum, s.min);
      put(leaf + kQuantum, quantum);
      put(leaf + kQuantMin, in_quanta(0, quantum));
      put(leaf + kQuantMax, in_quanta(s.max - s.min, quantum));
      put(leaf + kQuantAverage, in_quanta(average - s.min, quantum));
      put(leaf + kQuantStdDev, in_quanta(deviation, quantum));
    } else {
      put(leaf + kMin, s.min);
      put(leaf + kMax, s.max);
      put(leaf + kAverage, average);
      put(leaf + kStdDev, deviation);
    }
  }
};

}  // namespace weir
