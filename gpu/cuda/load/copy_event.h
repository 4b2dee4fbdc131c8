// Marks a copy's point in a stream, so that the host can wait for it without spinning.
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

  /// Marks the point after all work given to `stream` so far.
  void record(cudaStream_t stream) { check_cuda(cudaEventRecord(event_, stream), "recording an event"); }
  /// Waits until the recorded work is done. Returns at once if nothing was recorded. Throws Error(io), beginning with
  /// `what`, if a copy failed.
  void wait(std::string_view what = "copying to the device") const { check_cuda(cudaEventSynchronize(event_), what); }
  /// Returns whether the recorded work is done, or nothing was recorded. Only wait() reports a failure.
  bool done() const { return cudaEventQuery(event_) == cudaSuccess; }

 private:
  cudaEvent_t event_ = nullptr;
};

}  // namespace weir
