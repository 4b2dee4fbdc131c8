// Errors of the CUDA runtime as weir's own, and whether there is a device at all.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "format/base/error.h"

namespace weir {

/// The device has no room: with less of it taken, the same may succeed. Of kind io.
class DeviceFull : public Error {
 public:
  DeviceFull(const Message& message, std::uint64_t bytes) : Error(ErrorKind::io, message), bytes_(bytes) {}

  /// Bytes requested; 0 if unknown.
  std::uint64_t bytes() const noexcept { return bytes_; }

 private:
  std::uint64_t bytes_;
};

/// "cudaErrorMemoryAllocation, out of memory".
std::string cuda_text(cudaError_t code);

/// Throws Error(io) "WHAT: cuda_text(CODE)" unless `code` is success, DeviceFull where the device has no room for what
/// was asked, `bytes` of it; an error that does not stick to the context is cleared first.
void check_cuda(cudaError_t code, std::string_view what, std::uint64_t bytes = 0);

/// Devices that the driver shows; 0 where there is no driver or none is visible.
int device_count();

/// Throws Error(usage) where there is no such device, with what the driver said.
void check_device(int device);

/// Makes `device` the current one. Throws as check_device.
void use_device(int device);

}  // namespace weir
