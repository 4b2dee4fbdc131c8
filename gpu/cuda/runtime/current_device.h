// Another device current for a while: a library must not change which one its caller's thread works on, nor take memory
// of a device that nobody asked it to use.
#pragma once

#include <optional>

#include "format/base/error.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/runtime/driver_context.h"

namespace weir {

/// The calling thread's; 0 where there is none.
inline int current_device() {
  int device = 0;
  if (cudaGetDevice(&device) != cudaSuccess) cudaGetLastError();
  return device;
}

/// What was current when the object was made is so again at its end, a context that its caller made itself included. A
/// thread that had no context gets none of a device that the process has none of: cudaSetDevice() makes one, of some
/// hundred MiB, and each rank of a node would have one on its first device.
class KeptDevice {
 public:
  KeptDevice() : context_(current_context()), device_(current_device()) {}
  /// And `device` is current meanwhile. Throws Error(io).
  explicit KeptDevice(int device) : KeptDevice() {
    if (context_ == nullptr || device != device_) check_cuda(cudaSetDevice(device), "choosing the device");
  }
  ~KeptDevice() {
    if (current_context() == context_) return;
    if (context_ != nullptr || !has_context(device_)) {
      set_current_context(context_);
    } else if (cudaSetDevice(device_) != cudaSuccess) {
      cudaGetLastError();  // a refusal is not the next call's
    }
  }
  KeptDevice(const KeptDevice&) = delete;
  KeptDevice& operator=(const KeptDevice&) = delete;

 private:
  void* context_;
  int device_;
};

/// Calls free(), which gives back what lies on `device`, with that current: it may be any thread that does so last.
template <class Free>
void free_on(int device, const Free& free) noexcept {
  std::optional<KeptDevice> kept;
  try {
    kept.emplace(device);
  } catch (const Error&) {  // the device is gone: what else there was to free is
  }
  free();
}

}  // namespace weir
