// The words of a stream's coders as a device reads them: aligned, ahead of their use, and without testing for each
// word whether it exists. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/coefficient_decoder.h"

namespace weir::decode_detail {

struct alignas(16) Quad {
  std::uint32_t of[4];
};

/// Does what StreamWords does, with a ring of the next words in shared memory. Chunks of 16 bytes are loaded into the
/// ring long before they are used. If words are missing, it continues with other bytes, and `at` ends up before the
/// front.
class StreamQueue {
 public:
  static constexpr unsigned kRingBytes = 64;
  static constexpr unsigned kBytes = kRingBytes + 8;  ///< bytes of the ring and of what is kept beside it
  static constexpr std::int32_t kPlaces = 8;          ///< places of a run

  /// The words lie between `front` and `at`, which is not before `front`. Reads whole aligned units of 16 bytes.
  /// `ring` has kBytes bytes.
  WEIR_HOST_DEVICE void start(const std::byte* front, const std::byte* at, unsigned char* ring) {
    const std::size_t past = reinterpret_cast<std::uintptr_t>(front) & 15U;
    base_ = front - past;
    ring_ = ring;
    const auto end = static_cast<std::int32_t>(at - base_);
    odd_ = static_cast<unsigned>(end) & 1U;
    word_ = (end >> 1) - 1;
    chunk_ = (word_ >> 3) + 1;
    if (16 * chunk_ < end) carry() = reinterpret_cast<const Quad*>(base_)[chunk_].of[0];
    load();
    fill_up(2 * kPlaces + 1);
    next_ = word();
  }

  /// Call it before each run of eight places.
  WEIR_HOST_DEVICE void refill() {
    if (available() <= static_cast<std::int32_t>(kWords - kChunkWords)) {
      store();
      load();
    }
    fill_up(2 * kPlaces + 1);
  }
  /// Call it before taking more than two words for a place. Afterwards at least `least` words are in the ring. Pass one
  /// more than the words to be taken, because the next word is always read ahead.
  WEIR_HOST_DEVICE void fill_up(std::int32_t least) {
    WEIR_NO_UNROLL
    while (available() < least) {
      store();
      load();
    }
  }

  WEIR_HOST_DEVICE void renormalise(std::uint32_t& x) {
    if (x < kLeastState) {
      x = x << 16U | next_;
      --word_;
      next_ = word();
    }
  }
  /// Takes up to 16 raw bits of a state.
  WEIR_HOST_DEVICE std::uint32_t take(std::uint32_t& x, unsigned bits) {
    const std::uint32_t value = x & ((1U << bits) - 1U);
    x >>= bits;
    renormalise(x);
    return value;
  }
  /// Takes up to 32 raw bits.
  WEIR_HOST_DEVICE std::uint32_t bypass(std::uint32_t& x, unsigned bits) {
    const unsigned first = bits < 16 ? bits : 16;
    const std::uint32_t value = take(x, first);
    return value | take(x, bits - first) << 16U;
  }
  /// Returns the end of the words that are left.
  WEIR_HOST_DEVICE const std::byte* at() const {
    return base_ + (2 * (static_cast<std::ptrdiff_t>(word_) + 1) + static_cast<std::ptrdiff_t>(odd_));
  }

 private:
  static constexpr unsigned kWords = kRingBytes / 2;
  static constexpr unsigned kChunkWords = 8;

  WEIR_HOST_DEVICE std::int32_t available() const {
    return word_ + 1 - static_cast<std::int32_t>(kChunkWords) * (chunk_ + 1);
  }
  WEIR_HOST_DEVICE std::uint32_t word() const {
    return *reinterpret_cast<const std::uint16_t*>(ring_ + 2 * (static_cast<unsigned>(word_) % kWords));
  }
  WEIR_HOST_DEVICE void load() {
    --chunk_;
    if (chunk_ < 0) return;
#if defined(__CUDA_ARCH__)
    const uint4 quad = __ldg(reinterpret_cast<const uint4*>(base_) + chunk_);
    loaded_ = {{quad.x, quad.y, quad.z, quad.w}};
#else
    loaded_ = reinterpret_cast<const Quad*>(base_)[chunk_];
#endif
  }
  // Puts the chunk that load() has loaded into the ring.
  WEIR_HOST_DEVICE void store() {
    auto* to = reinterpret_cast<std::uint32_t*>(ring_) + 4 * (static_cast<unsigned>(chunk_) % (kWords / kChunkWords));
    const unsigned bits = 8 * odd_;
    to[0] = joined(loaded_.of[0], loaded_.of[1], bits);
    to[1] = joined(loaded_.of[1], loaded_.of[2], bits);
    to[2] = joined(loaded_.of[2], loaded_.of[3], bits);
    to[3] = joined(loaded_.of[3], carry(), bits);
    carry() = loaded_.of[0];
  }
  // The first bytes of the chunk that was stored last. They lie in the ring's memory: into a register variable, a
  // compiler might copy a chunk whose load still runs, and so wait for it.
  WEIR_HOST_DEVICE std::uint32_t& carry() const { return *reinterpret_cast<std::uint32_t*>(ring_ + kRingBytes); }
  // Returns the 32 bits above the first `bits` < 32.
  WEIR_HOST_DEVICE static std::uint32_t joined(std::uint32_t low, std::uint32_t high, unsigned bits) {
#if defined(__CUDA_ARCH__)
    return __funnelshift_r(low, high, bits);
#else
    return static_cast<std::uint32_t>((static_cast<std::uint64_t>(high) << 32U | low) >> bits);
#endif
  }

  const std::byte* base_ = nullptr;  // at a multiple of 16
  unsigned char* ring_ = nullptr;
  std::int32_t word_ = 0;   // next word, counted from base_ + odd_
  std::int32_t chunk_ = 0;  // chunk that is loaded, but not in the ring yet
  std::uint32_t next_ = 0;
  unsigned odd_ = 0;
  Quad loaded_{};
};

}  // namespace weir::decode_detail
