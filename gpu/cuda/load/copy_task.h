// The input and the result of every way of loading.
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

/// Copies bytes [offset, offset + bytes) of a file to `target` on `device`, after the work queued in `stream`.
struct CopyTask {
  const FileMapping& file;
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
  std::byte* target = nullptr;
  int device = 0;  ///< the current device
  cudaStream_t stream = nullptr;
  std::uint64_t chunk_bytes = 0;
  int threads = 1;
  const std::atomic<bool>* cancel = nullptr;

  /// Throws Error(interrupted) if `cancel` is set.
  void check_cancelled() const {
    if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) {
      throw Error(ErrorKind::interrupted, "interrupted while loading " + file.path());
    }
  }
};

/// The copy is done if `refusal` is empty. Otherwise `refusal` says why this way does not work here; another way may.
struct CopyOutcome {
  std::string refusal;
  LoadStages stages;
};

/// Adds the seconds of its lifetime to a sum.
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
