// What the CUDA back end renders with.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gpu/cuda/grid_loader.h"

namespace weir {

struct CudaOptions {
  std::vector<int> devices{0};  ///< of one picture; each holds a copy of the grid
  LoadOptions load;
  bool atlas = true;  ///< trilinear lookups through a brick atlas where the device has room for it
  /// Bytes that volumes take of each device, at most; none: what is free but for a reserve.
  std::optional<std::uint64_t> memory = std::nullopt;
  std::uint64_t volumes = 1;  ///< that are held at a time and share it
  bool levels = false;        ///< pictures may ask for levels of detail
};

}  // namespace weir
