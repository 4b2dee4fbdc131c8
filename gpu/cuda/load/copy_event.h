// Marks a copy's point in a stream, to wait for it without spinning.
#pragma once

#include <string_view>
#include <utility>

#include "gpu/cuda/runtime/check.h"

namespace weir {

class CopyEvent {
 public:
  CopyEvent() {
    check_cuda(cudaEventCreateWithFlags(&event_, cudaEventBlockingSync | cudaEventDisableTiming), "making an event");
  }
  ~CopyEvent() {
    if (event_ != nullptr) cudaEventDestroy(event_);
  }
  CopyEvent(CopyEvent&& other) noexcept : event_(std::exchange(other.event_, nullptr)) {}
  CopyEvent& operator=(CopyEvent&& other) noexcept {
    std::swap(event_, other.event_);
    return *this;
  }

  /// Marks the point after all that `stream` was given so far.
  void record(cudaStream_t stream) { check_cuda(cudaEventRecord(event_, stream), "recording an event"); }
  /// Waits until what was recorded is done; returns at once where nothing was. Throws Error(io), beginning with `what`,
  /// where a copy failed.
  void wait(std::string_view what = "copying to the device") const { check_cuda(cudaEventSynchronize(event_), what); }
  /// Whether it is done, or nothing was recorded; what failed is for wait() to say.
  bool done() const { return cudaEventQuery(event_) == cudaSuccess; }

 private:
  cudaEvent_t event_ = nullptr;
};

}  // namespace weir
