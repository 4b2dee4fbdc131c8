// A rough ball in a packed grid of raw blocks. It needs more bricks than a small cache holds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <random>
#include <span>
#include <string>

#include "format/nanovdb/nvdb_file.h"
#include "tests/support/packed_grid.h"

namespace weir::test {

inline constexpr std::uint64_t kSmallCache = 50U << 20U;  ///< bytes; less than all bricks of 200^3 voxels take
inline constexpr std::uint64_t kSmallCacheWithLevels = 76U << 20U;  ///< the same with levels of detail

/// Makes a ball of edge^3 voxels. If block (12, 12, 12) exists, its voxel 77 is `odd`.
inline PackedFile packed_ball(int edge = 200, float odd = 0.5F) {
  PackedGridOptions options;
  options.domain = {{-3, 5, 0}, {edge - 3, edge + 5, edge}};
  options.range = {0, 2};
  options.stream = [edge, odd](const Index3& block) -> PackedBytes {
    std::minstd_rand random(static_cast<std::uint32_t>(block.x * 7919 + block.y * 104729 + block.z * 1299709 + 1));
    std::array<float, 512> values;
    const double half = edge / 2.0;
    for (unsigned i = 0; i < 512; ++i) {
      const double x = static_cast<double>(8 * block.x + (i >> 6U)) - half + 3;
      const double y = static_cast<double>(8 * block.y + (i >> 3U & 7U)) - half - 5;
      const double z = static_cast<double>(8 * block.z + (i & 7U)) - half;
      const double inside = std::max(0.0, 1 - std::sqrt(x * x + y * y + z * z) / (half - 5));
      values[i] = static_cast<float>(inside * (0.9 + 0.2 * static_cast<double>(random() & 65535U) / 65536));
    }
    if (block == Index3{12, 12, 12}) values[77] = odd;
    return raw_stream(values);
  };
  return PackedGridBuilder::build(options);
}

/// Writes the bytes to a file at `path` and opens it.
inline std::shared_ptr<const NvdbFile> written(const std::string& path, std::span<const std::byte> bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return std::make_shared<const NvdbFile>(path);
}

}  // namespace weir::test
