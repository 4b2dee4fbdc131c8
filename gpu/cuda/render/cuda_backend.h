// The CUDA back end: grids on one device or several, each sample of a picture
// traced on one of them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gpu/cuda/grid_loader.h"
#include "gpu/render/backend.h"

namespace weir {

/// Macrocells of 32^3 voxels: measured faster than 16^3 and 64^3 (docs/performance.md).
inline constexpr std::int64_t kDeviceMacrocell = 32;

struct CudaOptions {
  std::vector<int> devices{0};  ///< of one picture; each holds a copy of the grid
  LoadOptions load;
  bool atlas = true;  ///< trilinear lookups through a brick atlas where the device has room for it
  /// Bytes that volumes take of each device, at most; none: what is free but for a reserve.
  std::optional<std::uint64_t> memory = std::nullopt;
  std::uint64_t volumes = 1;  ///< that are held at a time and share it
};

/// Throws Error(usage) where there is no such device.
std::unique_ptr<Backend> make_cuda_backend(const CudaOptions& options);

}  // namespace weir
