// The stream of one load, which runs after the work queued in another stream.
#pragma once

#include "gpu/cuda/runtime/caller_stream.h"
#include "gpu/cuda/runtime/check.h"

namespace weir {

/// A stream of its own, since the default stream may be another one in each of the threads that share a load.
class LoadStream {
 public:
  explicit LoadStream(cudaStream_t behind) {
    check_cuda(cudaStreamSynchronize(caller_stream(behind)), "work before a load");
    check_cuda(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "making a stream");
  }
  ~LoadStream() { cudaStreamDestroy(stream_); }
  LoadStream(const LoadStream&) = delete;
  LoadStream& operator=(const LoadStream&) = delete;

  cudaStream_t get() const { return stream_; }

 private:
  cudaStream_t stream_ = nullptr;
};

}  // namespace weir
