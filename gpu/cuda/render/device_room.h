// How much of a device a grid may take, and what becomes of one that needs more.
#pragma once

#include <cstdint>
#include <string>

#include "format/nanovdb/nvdb_grid.h"
#include "gpu/cuda/bricks/brick_cache.h"
#include "gpu/cuda/render/cuda_options.h"

namespace weir {

struct DeviceRoom {
  std::uint64_t bytes = 0;
  std::uint64_t free = 0;  ///< of the device, all in all
  std::uint64_t volumes = 1;
  bool limited = false;      ///< by what the caller asked for
  std::uint64_t levels = 0;  ///< of `bytes`, for levels of detail

  BrickBudget budget() const { return {.bytes = bytes, .levels = levels, .volumes = volumes, .limited = limited}; }
};

/// On the current device, which keeps `held` bytes for `grid` already.
DeviceRoom room_for(const NvdbGrid& grid, const CudaOptions& options, std::uint64_t held);

/// Why a grid cannot lie on the current device; "" where it can.
std::string reason_for_zero_copy(const NvdbGrid& grid, const DeviceRoom& room);

/// Whether a grid in host memory has a cache of `memory` bytes on the device, not its table alone.
bool worth_bricks(const NvdbGrid& grid, std::uint64_t memory);

}  // namespace weir
