#include "gpu/cuda/load/registered_range.h"

#include <cuda_runtime_api.h>

#include <utility>

#include "format/base/text.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/runtime/current_device.h"

namespace weir {
namespace {

bool has_attribute(cudaDeviceAttr attribute) {
  int value = 0;
  check_cuda(cudaDeviceGetAttribute(&value, attribute, existing_current_device()),
             "asking for an attribute of the device");
  return value != 0;
}

// Returns whether `code` says that this memory cannot be page-locked here, not that the device or earlier work
// failed.
bool is_refusal(cudaError_t code) {
  switch (code) {
    case cudaErrorNotSupported:
    case cudaErrorNotPermitted:
    case cudaErrorOperatingSystem:
    case cudaErrorMemoryAllocation:
    case cudaErrorInvalidValue:
    case cudaErrorHostMemoryAlreadyRegistered:
      return true;
    default:
      return false;
  }
}

}  // namespace

std::optional<RegisteredRange> RegisteredRange::make(std::span<const std::byte> range, Use use, std::string& refusal) {
  // A read-only mapping needs the flag, unless the device walks the host's page tables (CUDA Runtime API,
  // cudaHostRegister).
  const bool read_only = has_attribute(cudaDevAttrHostRegisterReadOnlySupported);
  if (!read_only && !has_attribute(cudaDevAttrPageableMemoryAccessUsesHostPageTables)) {
    refusal = "the device does not register read-only memory";
    return std::nullopt;
  }
  const unsigned flags = (read_only ? cudaHostRegisterReadOnly : 0U) |
                         (use == Use::in_place ? cudaHostRegisterMapped : cudaHostRegisterDefault);
  void* const address = const_cast<std::byte*>(range.data());
  const cudaError_t code = cudaHostRegister(address, range.size(), flags);
  const std::string what = cat("registering ", format_bytes(range.size()), " of the file");
  if (is_refusal(code)) {
    cudaGetLastError();
    // A failure of earlier work may have one of these codes too. It is reported again by any later call.
    check_cuda(cudaFree(nullptr), what);
    refusal = cat(what, ": ", cuda_text(code));
    return std::nullopt;
  }
  check_cuda(code, what);
  return RegisteredRange(address);
}

RegisteredRange::~RegisteredRange() {
  if (address_ != nullptr && cudaHostUnregister(address_) != cudaSuccess) cudaGetLastError();
}

RegisteredRange::RegisteredRange(RegisteredRange&& other) noexcept : address_(std::exchange(other.address_, nullptr)) {}

RegisteredRange& RegisteredRange::operator=(RegisteredRange&& other) noexcept {
  std::swap(address_, other.address_);
  return *this;
}

const std::byte* RegisteredRange::device_address() const {
  void* device = nullptr;
  check_cuda(cudaHostGetDevicePointer(&device, address_, 0), "asking for the device's address of the file");
  return static_cast<const std::byte*>(device);
}

void RegisteredRange::release() {
  if (address_ == nullptr) return;
  check_cuda(cudaHostUnregister(address_), "unregistering the file");
  address_ = nullptr;
}

}  // namespace weir
