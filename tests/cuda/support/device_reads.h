// Look-ups made by kernels, which tests compare with the host's.
#pragma once

#include <vector>

#include "gpu/cuda/bricks/brick_cache.h"
#include "gpu/cuda/volume/device_table.h"
#include "gpu/volume/volume_sampler.h"

namespace weir::test {

/// Returns every voxel of the table's domain, x fastest.
template <class Block>
std::vector<float> read_voxels(const BlockTable<Block>& table);

/// Returns `smooth` at each position, nearest or trilinear.
template <class Block>
std::vector<float> read_smooth(const BlockTable<Block>& table, Filter filter, const std::vector<Float3>& positions);
/// For a cache that holds all bricks.
std::vector<float> read_smooth(BrickCache& bricks, Filter filter, const std::vector<Float3>& positions);
/// Returns the mean of `draws` stochastic samples at each position.
template <class Block>
std::vector<float> read_stochastic(const BlockTable<Block>& table, const std::vector<Float3>& positions, int draws);
std::vector<float> read_stochastic(BrickCache& bricks, const std::vector<Float3>& positions, int draws);

}  // namespace weir::test

/// Skips a test if there is no device.
#define WEIR_NEEDS_DEVICE() \
  if (device_count() == 0) GTEST_SKIP() << "no CUDA device"
