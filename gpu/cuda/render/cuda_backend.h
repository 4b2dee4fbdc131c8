// The CUDA back end: grids on one or several devices. Each sample of a picture is traced on one device.
#pragma once

#include <cstdint>
#include <memory>

#include "gpu/cuda/render/cuda_options.h"
#include "gpu/render/backend.h"

namespace weir {

/// Macrocells of 32^3 voxels were faster than 16^3 and 64^3 (docs/what-was-tried.md).
inline constexpr std::int64_t kDeviceMacrocell = 32;

/// Throws Error(usage) if there is no such device.
std::unique_ptr<Backend> make_cuda_backend(const CudaOptions& options);

}  // namespace weir
