// Turns errors of the CUDA runtime into weir's, and tells whether there is a device.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "format/base/error.h"

namespace weir {

/// The device has no room. The same call may succeed when less of the device is in use. Its kind is io.
class DeviceFull : public Error {
 public:
  DeviceFull(const Message& message, std::uint64_t bytes) : Error(ErrorKind::io, message), bytes_(bytes) {}

  /// Bytes requested; 0 if unknown.
  std::uint64_t bytes() const noexcept { return bytes_; }

 private:
  std::uint64_t bytes_;
};

/// Returns, for example, "cudaErrorMemoryAllocation, out of memory".
std::string cuda_text(cudaError_t code);

/// Throws Error(io) "WHAT: cuda_text(CODE)" unless `code` is success. Throws DeviceFull if the device has no room for
/// the requested `bytes`. First clears an error that does not stick to the context.
void check_cuda(cudaError_t code, std::string_view what, std::uint64_t bytes = 0);

/// Returns the number of devices that the driver shows; 0 if there is no driver or no visible device.
int device_count();

/// Throws Error(usage), with the driver's reason, if there is no such device.
void check_device(int device);

/// Makes `device` the current device. Throws the errors of check_device().
void use_device(int device);

}  // namespace weir
