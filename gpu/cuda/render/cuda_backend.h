// The CUDA back end: grids on one device or several, each sample of a picture
// traced on one of them.
#pragma once

#include <cstdint>
#include <memory>

#include "gpu/cuda/render/cuda_options.h"
#include "gpu/render/backend.h"

namespace weir {

/// Macrocells of 32^3 voxels: measured faster than 16^3 and 64^3 (docs/what-was-tried.md).
inline constexpr std::int64_t kDeviceMacrocell = 32;

/// Throws Error(usage) where there is no such device.
std::unique_ptr<Backend> make_cuda_backend(const CudaOptions& options);

}  // namespace weir
