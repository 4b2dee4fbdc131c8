// Errors of the CUDA runtime as weir's own, and whether there is a device at all.
#pragma once

#include <cuda_runtime_api.h>

#include <string>
#include <string_view>

namespace weir {

/// "cudaErrorMemoryAllocation, out of memory".
std::string cuda_text(cudaError_t code);

/// Throws Error(io) "WHAT: cuda_text(CODE)" unless `code` is success; an error that does not stick to the
/// context is cleared first.
void check_cuda(cudaError_t code, std::string_view what);

/// Devices that the driver shows; 0 where there is no driver or none is visible.
int device_count();

/// Makes `device` the current one. Throws Error(usage) where there is no such device, with what the driver said.
void use_device(int device);

}  // namespace weir
