// Memory for what threads hold of a selection, in pieces of one size out of large pages: a small page costs the time in
// which a hundred steps are found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "ingest/plan/page_buffer.h"

namespace weir {

/// Thread-safe. Memory goes back to the system with the object.
class StepPieces {
 public:
  static constexpr std::size_t kPieceBytes = std::size_t{1} << 18U;

  /// Takes up to `most_bytes` of memory, as it is needed.
  explicit StepPieces(std::uint64_t most_bytes) : left_(most_bytes / kPieceBytes) {}
  ~StepPieces();
  StepPieces(const StepPieces&) = delete;
  StepPieces& operator=(const StepPieces&) = delete;

  /// kPieceBytes that nobody else has; empty where there are no more. Throws Error(io) where the system refuses.
  std::span<std::byte> next();

 private:
  std::mutex mutex_;
  std::uint64_t left_;              // pieces that are not given
  std::vector<PageBuffer> blocks_;  // of several pieces each
  std::span<std::byte> rest_;       // of the last block
};

}  // namespace weir
