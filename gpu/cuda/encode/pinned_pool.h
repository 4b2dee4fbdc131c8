// Page-locked memory that has served, for whoever needs some next: a system locks a few MiB a millisecond, and a
// simulation saves one step after the other.
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
  /// What it holds at most: what came back first is freed.
  static constexpr std::size_t kMostHeld = std::size_t{96} << 20U;

  /// The process's. It stays until the process ends, and with it what it holds.
  static PinnedPool& of_process();

  /// The smallest piece held that has so many bytes, and at most four times as many, or a new one, in place of one that
  /// is held; otherwise as PinnedMemory::make.
  std::optional<Piece> take(std::size_t bytes, std::string& refusal);
  void give_back(Piece piece) noexcept;
  /// Frees what it holds.
  void clear();
  std::size_t held_bytes() const;

 private:
  std::optional<Piece> take_held(std::size_t bytes, std::uint64_t context);
  void free_oldest();

  mutable std::mutex mutex_;
  HeldPieces<Piece> held_;
};

}  // namespace weir
