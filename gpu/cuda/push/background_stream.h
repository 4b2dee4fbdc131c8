// A stream with a lower priority than the caller's kernels.
#pragma once

#include "gpu/cuda/runtime/check.h"

namespace weir {

class BackgroundStream {
 public:
  /// Makes the stream on the current device. Throws Error(io).
  BackgroundStream() {
    int least = 0;
    int greatest = 0;
    check_cuda(cudaDeviceGetStreamPriorityRange(&least, &greatest), "asking for the priorities of streams");
    check_cuda(cudaStreamCreateWithPriority(&stream_, cudaStreamNonBlocking, least), "making a stream");
  }
  ~BackgroundStream() { cudaStreamDestroy(stream_); }
  BackgroundStream(const BackgroundStream&) = delete;
  BackgroundStream& operator=(const BackgroundStream&) = delete;

  cudaStream_t get() const { return stream_; }

 private:
  cudaStream_t stream_ = nullptr;
};

}  // namespace weir
