// The options of the CUDA back end.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gpu/cuda/grid_loader.h"

namespace weir {

struct CudaOptions {
  std::vector<int> devices{0};  ///< devices that share a picture; each holds a copy of the grid
  LoadOptions load;
  bool atlas = true;  ///< use a brick atlas for trilinear look-ups if the device has room for it
  /// Most bytes that volumes take on each device. If empty, they may take all free memory except a reserve.
  std::optional<std::uint64_t> memory = std::nullopt;
  std::uint64_t volumes = 1;  ///< volumes that are held at a time and share `memory`
  bool levels = false;        ///< pictures may ask for levels of detail
};

}  // namespace weir
