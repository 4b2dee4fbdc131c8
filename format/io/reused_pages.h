// Memory of files that are gone, for the next ones: a system makes 2 GB of pages a second and core, and a simulation
// saves one step after the other.
#pragma once

#include <cstddef>
#include <mutex>
#include <span>

#include "format/base/held_pieces.h"

namespace weir {

/// Anonymous mappings that the system may take the pages of wherever it needs memory (MADV_FREE); until then they count
/// as the process's. Thread-safe.
class ReusedPages {
 public:
  /// What it holds at most: what came back first is unmapped.
  static constexpr std::size_t kMostHeld = std::size_t{1} << 30U;
  /// Of a mapping: smaller ones are soon made.
  static constexpr std::size_t kLeast = std::size_t{16} << 20U;

  ReusedPages() = default;
  ~ReusedPages() { clear(); }
  ReusedPages(const ReusedPages&) = delete;
  ReusedPages& operator=(const ReusedPages&) = delete;

  /// The process's. It stays until the process ends, and with it what it holds.
  static ReusedPages& of_process();

  /// The smallest mapping held that has so many bytes, and at most twice as many; empty where there is none. Its bytes
  /// are any.
  std::span<std::byte> take(std::size_t bytes);
  /// `mapping`, whole pages, is no longer used by the caller.
  void give_back(std::span<std::byte> mapping) noexcept;
  /// Unmaps what it holds.
  void clear();
  std::size_t held_bytes() const;

 private:
  bool hold(std::span<std::byte> mapping) noexcept;
  void unmap_down_to(std::size_t bytes) noexcept;

  mutable std::mutex mutex_;
  HeldPieces<std::span<std::byte>> held_;
};

}  // namespace weir
