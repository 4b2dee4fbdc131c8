// How much of a device a grid may take, and where a grid goes that needs more.
#pragma once

#include <cstdint>
#include <string>

#include "format/nanovdb/nvdb_grid.h"
#include "gpu/cuda/bricks/brick_cache.h"
#include "gpu/cuda/render/cuda_options.h"

namespace weir {

struct DeviceRoom {
  std::uint64_t bytes = 0;
  std::uint64_t free = 0;  ///< free bytes of the device in total
  std::uint64_t volumes = 1;
  bool limited = false;      ///< true: limited by the caller's options
  std::uint64_t levels = 0;  ///< part of `bytes` for levels of detail

  BrickBudget budget() const { return {.bytes = bytes, .levels = levels, .volumes = volumes, .limited = limited}; }
};

/// Returns the room on the current device, which already holds `held` bytes for `grid`.
DeviceRoom room_for(const NvdbGrid& grid, const CudaOptions& options, std::uint64_t held);

/// Returns why a grid cannot lie on the current device; "" if it can.
std::string reason_for_zero_copy(const NvdbGrid& grid, const DeviceRoom& room);

/// Returns whether a grid in host memory gets a cache of `memory` bytes on the device, not only a table.
bool worth_bricks(const NvdbGrid& grid, std::uint64_t memory);

}  // namespace weir
