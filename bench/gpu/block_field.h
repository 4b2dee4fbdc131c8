// Synthetic volumes in the host's memory, their blocks, and loops over the blocks on all cores.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

#include "format/base/index.h"
#include "gpu/cuda/encode/encode_call.h"
#include "ingest/synthetic/field.h"

namespace weir {

inline double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// Calls work(first, end) for runs of the indices below `count`, on all cores.
inline void on_all_cores(std::int64_t count, const std::function<void(std::int64_t first, std::int64_t end)>& work) {
  std::atomic<std::int64_t> next{0};
  constexpr std::int64_t kRun = 64;
  std::vector<std::jthread> threads;
  for (unsigned t = 0; t < std::max(1U, std::thread::hardware_concurrency()); ++t) {
    threads.emplace_back([&] {
      for (;;) {
        const std::int64_t first = kRun * next++;
        if (first >= count) return;
        work(first, std::min(first + kRun, count));
      }
    });
  }
}

/// A cube of float32 values, and its blocks, x fastest.
struct Field {
  std::int64_t edge;
  std::vector<float> values;  // x fastest

  std::int64_t blocks_along() const { return edge / 8; }
  std::int64_t blocks() const { return blocks_along() * blocks_along() * blocks_along(); }
  double bytes() const { return static_cast<double>(values.size()) * sizeof(float); }
  /// Returns the index of the block's region of 128^3.
  std::int64_t region_of(std::int64_t block) const {
    constexpr std::int64_t kRegion = 16;  // blocks along a region
    const std::int64_t n = blocks_along();
    const std::int64_t r = n / kRegion;
    return block % n / kRegion + r * (block / n % n / kRegion + r * (block / n / n / kRegion));
  }
  void block(std::int64_t b, std::array<float, 512>& to) const {
    const std::int64_t n = blocks_along();
    const float* corner = values.data() + 8 * (b % n) + edge * 8 * (b / n % n) + edge * edge * 8 * (b / n / n);
    for (std::int64_t i = 0; i < 512; ++i) {
      to[static_cast<std::size_t>(i)] = corner[(i >> 6) + edge * (i >> 3 & 7) + edge * edge * (i & 7)];
    }
  }
  BlockBox box(const float* on_device) const {
    BlockBox box;
    box.values = on_device;
    for (int axis = 0; axis < 3; ++axis) {
      box.extent[axis] = static_cast<std::int32_t>(edge);
      box.blocks[axis] = static_cast<std::uint32_t>(blocks_along());
    }
    return box;
  }
};

inline Field fill(const SyntheticField& field, std::int64_t edge) {
  Field filled{edge, std::vector<float>(static_cast<std::size_t>(edge * edge * edge))};
  const std::int64_t tiles = ceil_div(edge, kTileDim);
  on_all_cores(tiles * tiles * tiles, [&](std::int64_t first, std::int64_t end) {
    for (std::int64_t t = first; t < end; ++t) {
      const Index3 lo = index_at(t, {tiles, tiles, tiles}) * kTileDim;
      const Box box{lo, min(lo + Index3{kTileDim, kTileDim, kTileDim}, {edge, edge, edge})};
      field.fill({box, filled.values.data() + linear_index(lo, {edge, edge, edge}), edge, edge * edge});
    }
  });
  return filled;
}

}  // namespace weir
