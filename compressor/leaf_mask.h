// Which leaves of a 128^3 region are kept: one bit per leaf, in the order of the
// lower node's masks (x<<8 | y<<4 | z), and a spill file of them.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>

#include "format/file_system.h"

namespace weir {

class LeafMask {
 public:
  void set(std::size_t position) { words_[position / 64] |= std::uint64_t{1} << (position % 64); }
  bool test(std::size_t position) const { return (words_[position / 64] >> (position % 64) & 1U) != 0; }
  bool empty() const { return count() == 0; }
  std::uint32_t count() const { return count_before(kBits); }
  /// Kept leaves before `position`: the rank of a kept leaf in its lower node.
  std::uint32_t count_before(std::size_t position) const {
    std::uint32_t total = 0;
    for (std::size_t w = 0; w < position / 64; ++w) total += static_cast<std::uint32_t>(std::popcount(words_[w]));
    if (position % 64 != 0) {
      total += static_cast<std::uint32_t>(
          std::popcount(words_[position / 64] & ((std::uint64_t{1} << (position % 64)) - 1)));
    }
    return total;
  }

 private:
  static constexpr std::size_t kBits = 4096;
  std::array<std::uint64_t, kBits / 64> words_{};
};
static_assert(sizeof(LeafMask) == 512, "masks are spilled as they are");

/// Masks by region index. Thread-safe for different regions.
class MaskStore {
 public:
  MaskStore(std::unique_ptr<File> file, std::int64_t regions) : file_(std::move(file)) {
    file_->preallocate(static_cast<std::uint64_t>(regions) * sizeof(LeafMask));
  }
  void write(std::int64_t region, const LeafMask& mask) {
    file_->write_at(at(region), std::as_bytes(std::span(&mask, 1)));
  }
  LeafMask read(std::int64_t region) const {
    LeafMask mask;
    file_->read_at(at(region), std::as_writable_bytes(std::span(&mask, 1)));
    return mask;
  }

 private:
  static std::uint64_t at(std::int64_t region) { return static_cast<std::uint64_t>(region) * sizeof(LeafMask); }
  std::unique_ptr<File> file_;
};

}  // namespace weir
