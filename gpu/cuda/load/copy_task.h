// What every way of loading is given and what it returns.
#pragma once

#include <cuda_runtime_api.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

#include "format/base/error.h"
#include "format/io/file_mapping.h"
#include "gpu/cuda/load/load_report.h"

namespace weir {

/// Bytes [offset, offset + bytes) of a file to `target` on `device`, after the work queued in `stream`.
struct CopyTask {
  const FileMapping& file;
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
  std::byte* target = nullptr;
  int device = 0;  ///< the current one
  cudaStream_t stream = nullptr;
  std::uint64_t chunk_bytes = 0;
  int threads = 1;
  const std::atomic<bool>* cancel = nullptr;

  /// Throws Error(interrupted) where cancel is set.
  void check_cancelled() const {
    if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) {
      throw Error(ErrorKind::interrupted, "interrupted while loading " + file.path());
    }
  }
};

/// Done where `refusal` is empty; else it says why this way does not work here, and another may.
struct CopyOutcome {
  std::string refusal;
  LoadStages stages;
};

/// Adds the seconds of its life to a sum.
class StageClock {
 public:
  explicit StageClock(double& sum) : sum_(sum) {}
  ~StageClock() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

 private:
  double& sum_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace weir
