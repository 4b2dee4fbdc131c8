// Memory for the steps that threads hold for a selection: pieces of one size, on large pages. A small page would cost
// as much time as finding a hundred steps.
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

  /// Takes up to `most_bytes` of memory as needed.
  explicit StepPieces(std::uint64_t most_bytes) : left_(most_bytes / kPieceBytes) {}
  ~StepPieces();
  StepPieces(const StepPieces&) = delete;
  StepPieces& operator=(const StepPieces&) = delete;

  /// Returns a new piece of kPieceBytes; empty if all pieces are given out. Throws Error(io) if the system refuses
  /// memory.
  std::span<std::byte> next();

 private:
  std::mutex mutex_;
  std::uint64_t left_;              // pieces not yet given out
  std::vector<PageBuffer> blocks_;  // of several pieces each
  std::span<std::byte> rest_;       // of the last block
};

}  // namespace weir
