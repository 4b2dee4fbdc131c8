// Keeps the memory of removed files for the next ones. A system makes only 2 GB of pages a second and core, and a
// simulation saves one step after the other.
#pragma once

#include <cstddef>
#include <mutex>
#include <span>

#include "format/base/held_pieces.h"

namespace weir {

/// Holds anonymous mappings. The system may take their pages when it needs memory (MADV_FREE); until then they count as
/// the process's. Thread-safe.
class ReusedPages {
 public:
  /// The most bytes held; beyond that, the mapping that came back first is unmapped.
  static constexpr std::size_t kMostHeld = std::size_t{1} << 30U;
  /// The smallest mapping that is held; smaller ones are made quickly.
  static constexpr std::size_t kLeast = std::size_t{16} << 20U;

  ReusedPages() = default;
  ~ReusedPages() { clear(); }
  ReusedPages(const ReusedPages&) = delete;
  ReusedPages& operator=(const ReusedPages&) = delete;

  /// Returns the object of the process, which keeps its mappings until the process ends.
  static ReusedPages& of_process();

  /// Returns the smallest held mapping of at least `bytes` and at most twice as many; empty if there is none. It holds
  /// arbitrary bytes.
  std::span<std::byte> take(std::size_t bytes);
  /// Takes back `mapping` (whole pages), which the caller no longer uses.
  void give_back(std::span<std::byte> mapping) noexcept;
  /// Unmaps all held mappings.
  void clear();
  std::size_t held_bytes() const;

 private:
  bool hold(std::span<std::byte> mapping) noexcept;
  void unmap_down_to(std::size_t bytes) noexcept;

  mutable std::mutex mutex_;
  HeldPieces<std::span<std::byte>> held_;
};

}  // namespace weir
