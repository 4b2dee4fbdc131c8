#include "gpu/cuda/load/pinned_memory.h"

#include "format/base/text.h"
#include "gpu/cuda/runtime/check.h"

namespace weir {

void PinnedMemory::Free::operator()(std::byte* memory) const {
  if (cudaFreeHost(memory) != cudaSuccess) cudaGetLastError();
}

std::optional<PinnedMemory> PinnedMemory::make(std::uint64_t bytes, std::string& refusal) {
  void* memory = nullptr;
  const cudaError_t code = cudaHostAlloc(&memory, bytes, cudaHostAllocMapped);
  if (code == cudaSuccess) return PinnedMemory(static_cast<std::byte*>(memory));
  const std::string what = cat("page-locking ", format_bytes(bytes), " of host memory");
  if (code != cudaErrorMemoryAllocation && code != cudaErrorNotSupported && code != cudaErrorOperatingSystem) {
    check_cuda(code, what);
  }
  cudaGetLastError();
  check_cuda(cudaFree(nullptr), what);
  refusal = cat(what, ": ", cuda_text(code));
  return std::nullopt;
}

const std::byte* PinnedMemory::device_address() const {
  void* device = nullptr;
  check_cuda(cudaHostGetDevicePointer(&device, memory_.get(), 0), "asking for the device's address of host memory");
  return static_cast<const std::byte*>(device);
}

}  // namespace weir
