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

/// The same. Throws Error(io) where there is none.
inline int existing_current_device() {
  int device = 0;
  check_cuda(cudaGetDevice(&device), "asking for the current device");
  return device;
}

/// Makes the context of `device` that the runtime uses the calling thread's. Throws Error(io).
inline void enter_device(int device) {
  if (void* const context = primary_context(device)) {
    set_current_context(context);
  } else {
    check_cuda(cudaSetDevice(device), "choosing the device");
  }
}

/// What the calling thread works in, for threads that work for it or after it: its context, be it one that it made
/// itself, whose streams and memory are of no other; else the one of `device` that the runtime uses.
class SharedContext {
 public:
  explicit SharedContext(int device) : context_(current_context()), device_(device) {}

  /// Makes it the calling thread's. Throws Error(io).
  void enter() const {
    if (context_ != nullptr) {
      set_current_context(context_);
    } else {
      enter_device(device_);
    }
  }

 private:
  void* context_;
  int device_;
};

/// A device is current while the object lives. What was current before is so again at its end: a context that the
/// caller made itself, too, and none where there was none. cudaSetDevice() in place of that would have the thread
/// remember another device, and make a context, of some hundred MiB, on the one that it goes back to: each rank of a
/// node would have one on its first device.
class KeptDevice {
 public:
  /// In the calling thread's context, where that is of `device`. Throws Error(io).
  explicit KeptDevice(int device) : before_(current_context()) {
    if (before_ == nullptr || current_device() != device) enter_device(device);
  }
  /// In that context. Throws Error(io).
  explicit KeptDevice(const SharedContext& context) : before_(current_context()) { context.enter(); }
  ~KeptDevice() {
    if (current_context() != before_) set_current_context(before_);
  }
  KeptDevice(const KeptDevice&) = delete;
  KeptDevice& operator=(const KeptDevice&) = delete;

 private:
  void* before_;
};

/// Calls free(), which gives back what lies at `place`, a device or a SharedContext, with that current: it may be any
/// thread that does so last.
template <class Place, class Free>
void free_on(const Place& place, const Free& free) noexcept {
  std::optional<KeptDevice> kept;
  try {
    kept.emplace(place);
  } catch (const Error&) {  // the device is gone: what else there was to free is
  }
  free();
}

}  // namespace weir
