#include "gpu/cuda/runtime/check.h"

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

std::string cuda_text(cudaError_t code) { return cat(cudaGetErrorName(code), ", ", cudaGetErrorString(code)); }

void check_cuda(cudaError_t code, std::string_view what, std::uint64_t bytes) {
  if (code == cudaSuccess) return;
  cudaGetLastError();
  if (code == cudaErrorMemoryAllocation) throw DeviceFull(cat(what, ": ", cuda_text(code)), bytes);
  throw Error(ErrorKind::io, cat(what, ": ", cuda_text(code)));
}

int device_count() {
  int count = 0;
  if (cudaGetDeviceCount(&count) == cudaSuccess) return count;
  cudaGetLastError();
  return 0;
}

void check_device(int device) {
  int count = 0;
  const cudaError_t code = cudaGetDeviceCount(&count);
  if (code != cudaSuccess || count == 0) {
    cudaGetLastError();
    throw Error(ErrorKind::usage, compose("no CUDA device: ", code == cudaSuccess ? "none is visible" : cuda_text(code),
                                          "; use ", option("backend", "cpu")));
  }
  if (device < 0 || device >= count) {
    throw Error(ErrorKind::usage, cat("there is no CUDA device ", device, ", the last is ", count - 1));
  }
}

void use_device(int device) {
  check_device(device);
  check_cuda(cudaSetDevice(device), cat("CUDA device ", device));
}

}  // namespace weir
