// Keeps used page-locked memory for its next user. A system locks only a few MiB per millisecond, and a simulation
// saves one step after the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "format/base/held_pieces.h"
#include "gpu/cuda/load/pinned_memory.h"

namespace weir {

/// Thread-safe.
class PinnedPool {
 public:
  struct Piece {
    PinnedMemory memory;
    std::size_t bytes;
    int device;
    std::uint64_t context;  ///< current_context_id() when it was locked
  };
  /// Most bytes that the pool holds. Beyond this, it frees the piece that came back first.
  static constexpr std::size_t kMostHeld = std::size_t{96} << 20U;

  /// Returns the pool of the process. It and the memory that it holds stay until the process ends.
  static PinnedPool& of_process();

  /// Returns the smallest held piece that has at least `bytes` and at most four times as many. Otherwise frees the
  /// oldest held piece and returns a new one, as PinnedMemory::make does.
  std::optional<Piece> take(std::size_t bytes, std::string& refusal);
  void give_back(Piece piece) noexcept;
  /// Frees all held pieces.
  void clear();
  std::size_t held_bytes() const;

 private:
  std::optional<Piece> take_held(std::size_t bytes, std::uint64_t context);
  void free_oldest();

  mutable std::mutex mutex_;
  HeldPieces<Piece> held_;
};

}  // namespace weir
