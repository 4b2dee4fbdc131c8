// A stream for work that runs beside another stream's.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <utility>

#include "gpu/cuda/runtime/check.h"

namespace weir {

class SideStream {
 public:
  SideStream() : SideStream(nullptr) {  // delegates, so that the destructor runs if the rest throws
    check_cuda(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "making a stream");
    check_cuda(cudaEventCreateWithFlags(&begin_, cudaEventDisableTiming), "making an event");
    check_cuda(cudaEventCreateWithFlags(&end_, cudaEventDisableTiming), "making an event");
  }
  ~SideStream() {
    if (begin_ != nullptr) cudaEventDestroy(begin_);
    if (end_ != nullptr) cudaEventDestroy(end_);
    if (stream_ != nullptr) cudaStreamDestroy(stream_);
  }
  SideStream(SideStream&& other) noexcept
      : stream_(std::exchange(other.stream_, nullptr)),
        begin_(std::exchange(other.begin_, nullptr)),
        end_(std::exchange(other.end_, nullptr)) {}
  SideStream& operator=(SideStream&& other) noexcept {
    std::swap(stream_, other.stream_);
    std::swap(begin_, other.begin_);
    std::swap(end_, other.end_);
    return *this;
  }

  cudaStream_t get() const { return stream_; }
  /// Makes later work of this stream wait for the work that `other` has so far.
  void leave(cudaStream_t other) const { order(other, begin_, stream_); }
  /// Makes later work of `other` wait for the work that this stream has so far.
  void join(cudaStream_t other) const { order(stream_, end_, other); }

 private:
  explicit SideStream(std::nullptr_t) {}
  static void order(cudaStream_t first, cudaEvent_t event, cudaStream_t second) {
    check_cuda(cudaEventRecord(event, first), "recording an event");
    check_cuda(cudaStreamWaitEvent(second, event, 0), "waiting for an event");
  }

  cudaStream_t stream_ = nullptr;
  cudaEvent_t begin_ = nullptr;
  cudaEvent_t end_ = nullptr;
};

}  // namespace weir
