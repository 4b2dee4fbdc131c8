// The stream of one load. It starts after the work that is queued in another stream.
#pragma once

#include "gpu/cuda/runtime/caller_stream.h"
#include "gpu/cuda/runtime/check.h"

namespace weir {

/// A separate stream, because the default stream may be a different one in each thread that shares a load.
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
