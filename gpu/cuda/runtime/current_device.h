// Another device current for a while: a library must not change which one its caller's thread works on.
#pragma once

#include "gpu/cuda/runtime/check.h"

namespace weir {

/// The calling thread's; 0 where there is none.
inline int current_device() {
  int device = 0;
  if (cudaGetDevice(&device) != cudaSuccess) cudaGetLastError();
  return device;
}

/// The device that was current when the object was made is so again at its end.
class KeptDevice {
 public:
  KeptDevice() : before_(current_device()) {}
  /// And `device` is current meanwhile. Throws Error(io).
  explicit KeptDevice(int device) : KeptDevice() {
    if (device != before_) check_cuda(cudaSetDevice(device), "choosing the device");
  }
  ~KeptDevice() {
    int now = before_;
    if (cudaGetDevice(&now) == cudaSuccess && now == before_) return;
    // A refusal is not the next call's.
    if (cudaSetDevice(before_) != cudaSuccess) cudaGetLastError();
  }
  KeptDevice(const KeptDevice&) = delete;
  KeptDevice& operator=(const KeptDevice&) = delete;

 private:
  int before_;
};

}  // namespace weir
