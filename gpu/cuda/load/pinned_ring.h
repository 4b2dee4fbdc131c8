// Page-locked staging buffers, and copying a file through them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "gpu/cuda/load/copy_task.h"
#include "gpu/cuda/load/pinned_memory.h"

namespace weir {

/// Two buffers of `piece_bytes` per thread: one is filled while the other copies. Locking memory takes longer than
/// reading it, so keep the ring for the next load. It serves one load at a time.
class PinnedRing {
 public:
  static constexpr std::uint64_t kPieceBytes = 4ULL << 20U;
  static constexpr int kThreads = 8;

  /// Returns nothing, or throws, as PinnedMemory::make does.
  static std::optional<PinnedRing> make(std::uint64_t piece_bytes, int threads, std::string& refusal);

  std::uint64_t piece_bytes() const { return piece_bytes_; }
  /// Each thread takes the next piece of the file, reads it by pread and queues its copy. Returns when all is copied.
  /// No copy runs after the return or after a throw. Throws Error(input, io, interrupted).
  LoadStages copy(const CopyTask& task);

 private:
  PinnedRing(PinnedMemory memory, std::uint64_t piece_bytes, int threads)
      : memory_(std::move(memory)), piece_bytes_(piece_bytes), threads_(threads) {}

  PinnedMemory memory_;
  std::uint64_t piece_bytes_;
  int threads_;
};

}  // namespace weir
