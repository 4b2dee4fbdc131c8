// Page-locked staging buffers, and copying a file through them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "gpu/cuda/load/copy_task.h"
#include "gpu/cuda/load/pinned_memory.h"

namespace weir {

/// Buffers of `piece_bytes`, two a thread: one is filled while the other copies. Locking memory takes longer than
/// reading it, so keep the ring for the next load. One load at a time.
class PinnedRing {
 public:
  static constexpr std::uint64_t kPieceBytes = 4ULL << 20U;
  static constexpr int kThreads = 8;

  /// As PinnedMemory::make.
  static std::optional<PinnedRing> make(std::uint64_t piece_bytes, int threads, std::string& refusal);

  std::uint64_t piece_bytes() const { return piece_bytes_; }
  /// Every thread takes the next piece of the file, reads it by pread and queues its copy. Returns when all is
  /// there; nothing copies then, nor after a throw. Throws Error(input, io, interrupted).
  LoadStages copy(const CopyTask& task);

 private:
  PinnedRing(PinnedMemory memory, std::uint64_t piece_bytes, int threads)
      : memory_(std::move(memory)), piece_bytes_(piece_bytes), threads_(threads) {}

  PinnedMemory memory_;
  std::uint64_t piece_bytes_;
  int threads_;
};

}  // namespace weir
