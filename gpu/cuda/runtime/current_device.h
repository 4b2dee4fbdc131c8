// Makes another device current for a while. A library must not change the device that its caller's thread works on,
// nor take memory of a device that nobody asked it to use.
#pragma once

#include <optional>

#include "format/base/error.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/runtime/driver_context.h"

namespace weir {

/// Returns the calling thread's current device; 0 if there is none.
inline int current_device() {
  int device = 0;
  if (cudaGetDevice(&device) != cudaSuccess) cudaGetLastError();
  return device;
}

/// Returns the calling thread's current device. Throws Error(io) if there is none.
inline int existing_current_device() {
  int device = 0;
  check_cuda(cudaGetDevice(&device), "asking for the current device");
  return device;
}

/// Makes the runtime's context of `device` the calling thread's context. Throws Error(io).
inline void enter_device(int device) {
  if (void* const context = primary_context(device)) {
    set_current_context(context);
  } else {
    check_cuda(cudaSetDevice(device), "choosing the device");
  }
}

/// The context that the calling thread works in, for other threads that work for it or after it. It may be a context
/// that the caller made itself, which owns its streams and memory. If the thread has none, it is the runtime's
/// context of `device`.
class SharedContext {
 public:
  explicit SharedContext(int device) : context_(current_context()), device_(device) {}

  /// Makes this context the calling thread's. Throws Error(io).
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

/// Makes a device current while the object lives. Its end restores what was current before, including a context that
/// the caller made itself, or no context. cudaSetDevice() would not do: it would make the thread remember another
/// device, and make a context of some hundred MiB on the device that the thread returns to. Then each rank of a node
/// would have a context on its first device.
class KeptDevice {
 public:
  /// Stays in the calling thread's context if it belongs to `device`. Throws Error(io).
  explicit KeptDevice(int device) : before_(current_context()) {
    if (before_ == nullptr || current_device() != device) enter_device(device);
  }
  /// Enters `context`. Throws Error(io).
  explicit KeptDevice(const SharedContext& context) : before_(current_context()) { context.enter(); }
  ~KeptDevice() {
    if (current_context() != before_) set_current_context(before_);
  }
  KeptDevice(const KeptDevice&) = delete;
  KeptDevice& operator=(const KeptDevice&) = delete;

 private:
  void* before_;
};

/// Calls free() while `place`, a device or a SharedContext, is current. free() releases what lies there; any thread
/// may be the last user and do this.
template <class Place, class Free>
void free_on(const Place& place, const Free& free) noexcept {
  std::optional<KeptDevice> kept;
  try {
    kept.emplace(place);
  } catch (const Error&) {  // the device is gone: free() still releases the rest
  }
  free();
}

}  // namespace weir
