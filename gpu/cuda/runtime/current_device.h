// Another device current for a while: a library must not change which one its caller's thread works on.
#pragma once

#include "gpu/cuda/runtime/check.h"

namespace weir {

/// The device that was current when the object was made is so again at its end.
class KeptDevice {
 public:
  KeptDevice() {
    if (cudaGetDevice(&before_) != cudaSuccess) cudaGetLastError();
  }
  /// And `device` is current meanwhile. Throws Error(io).
  explicit KeptDevice(int device) : KeptDevice() {
    if (device != before_) check_cuda(cudaSetDevice(device), "choosing the device");
  }
  ~KeptDevice() {
    int now = before_;
    if (cudaGetDevice(&now) != cudaSuccess || now != before_) cudaSetDevice(before_);
  }
  KeptDevice(const KeptDevice&) = delete;
  KeptDevice& operator=(const KeptDevice&) = delete;

 private:
  int before_ = 0;
};

}  // namespace weir
