// Decodes the coded values of a packed block: interleaved rANS over contexts of decoded neighbours (FORMAT.md, "Coded
// values"; Duda 2013, Giesen 2014). For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#if defined(__SSE2__) && !defined(__CUDA_ARCH__)
#include <emmintrin.h>
#endif

#include "format/base/host_device.h"
#include "format/packed/block_constants.h"
#include "format/packed/block_context.h"
#include "format/packed/block_scan.h"

namespace weir {

inline constexpr std::uint32_t kLeastState = 65536;
inline constexpr unsigned kFrequencyBits = 12;
/// Coefficients that `end` counts by.
inline constexpr unsigned kEndUnit = 16;
/// Streams of at most this `end` have one state, others two.
inline constexpr unsigned kOneStateEnd = 8;
inline constexpr unsigned kEscape = kPackedSymbols - 1;

WEIR_HOST_DEVICE inline unsigned states_of(unsigned end) { return end <= kOneStateEnd ? 1 : 2; }

/// Bits of a stream read from the lowest up; zeros beyond its end, which `ok` tells.
class BitReader {
 public:
  WEIR_HOST_DEVICE BitReader(const std::byte* bytes, std::uint32_t count) : bytes_(bytes), count_(count) {}
  WEIR_HOST_DEVICE std::uint32_t read(unsigned bits) {
    std::uint32_t value = 0;
    for (unsigned got = 0; got < bits;) {
      const std::uint32_t byte = at_ >> 3U;
      if (byte >= count_) {
        at_ += bits - got;
        return value;
      }
      const unsigned offset = at_ & 7U;
      const unsigned take = bits - got < 8 - offset ? bits - got : 8 - offset;
      const std::uint32_t part = static_cast<std::uint32_t>(bytes_[byte]) >> offset & ((1U << take) - 1U);
      value |= part << got;
      got += take;
      at_ += take;
    }
    return value;
  }
  /// Bits, and whole bytes, read from.
  WEIR_HOST_DEVICE std::uint32_t bits_used() const { return at_; }
  WEIR_HOST_DEVICE std::uint32_t bytes_used() const { return (at_ + 7) >> 3U; }

 private:
  const std::byte* bytes_;
  std::uint32_t count_;
  std::uint32_t at_ = 0;
};

/// The words of a stream's coders, read from its end towards `front`; the next one is loaded ahead.
class StreamWords {
 public:
  WEIR_HOST_DEVICE void start(const std::byte* front, const std::byte* at) {
    front_ = front;
    at_ = at;
    load();
  }
  WEIR_HOST_DEVICE void renormalise(std::uint32_t& x) {
    if (x >= kLeastState) return;
    if (at_ - front_ < 2) {
      whole_ = false;
      x |= kLeastState;
      return;
    }
    x = x << 16U | next_;
    at_ -= 2;
    load();
  }
  /// Up to 32 bits of a state as they are.
  WEIR_HOST_DEVICE std::uint32_t bypass(std::uint32_t& x, unsigned bits) {
    std::uint32_t value = 0;
    for (unsigned got = 0; got < bits;) {
      const unsigned take = bits - got < 16 ? bits - got : 16;
      value |= (x & ((1U << take) - 1U)) << got;
      x >>= take;
      renormalise(x);
      got += take;
    }
    return value;
  }
  /// False once a word was missing.
  WEIR_HOST_DEVICE bool whole() const { return whole_; }
  WEIR_HOST_DEVICE const std::byte* at() const { return at_; }

 private:
  WEIR_HOST_DEVICE void load() {
    if (at_ - front_ < 2) return;
    next_ = static_cast<std::uint32_t>(at_[-2]) | static_cast<std::uint32_t>(at_[-1]) << 8U;
  }

  const std::byte* front_ = nullptr;
  const std::byte* at_ = nullptr;
  std::uint32_t next_ = 0;
  bool whole_ = true;
};

/// The states of a stream and its words.
class RansDecoder {
 public:
  /// False where the stream is too short.
  WEIR_HOST_DEVICE bool start(const std::byte* front, const std::byte* end, unsigned states, unsigned short_flags) {
    const std::byte* at = end;
    for (unsigned s = 0; s < states; ++s) {
      const unsigned bytes = (short_flags >> s & 1U) != 0 ? 3 : 4;
      if (at - front < static_cast<std::ptrdiff_t>(bytes)) return false;
      at -= bytes;
      std::uint32_t state = 0;
      for (unsigned b = 0; b < bytes; ++b) state |= static_cast<std::uint32_t>(at[b]) << (8 * b);
      state_[s] = state;
    }
    words_.start(front, at);
    return true;
  }

  WEIR_HOST_DEVICE unsigned symbol(unsigned s, const std::uint16_t* table) {
    std::uint32_t& x = state_[s];
    const std::uint32_t slot = x & ((1U << kFrequencyBits) - 1U);
    const unsigned found = find(table, slot);
    const std::uint32_t low = table[found];
    const std::uint32_t high = found + 1 < kPackedSymbols ? table[found + 1] : 1U << kFrequencyBits;
    x = (high - low) * (x >> kFrequencyBits) + slot - low;
    words_.renormalise(x);
    return found;
  }

  /// Up to 32 bits as they are.
  WEIR_HOST_DEVICE std::uint32_t bypass(unsigned s, unsigned bits) { return words_.bypass(state_[s], bits); }

  WEIR_HOST_DEVICE std::uint32_t state(unsigned s) const { return state_[s]; }
  WEIR_HOST_DEVICE const StreamWords& words() const { return words_; }

 private:
  // The last entry of the table that is not above `slot`.
  WEIR_HOST_DEVICE static unsigned find(const std::uint16_t* table, std::uint32_t slot) {
#if defined(__SSE2__) && !defined(__CUDA_ARCH__)
    const __m128i wanted = _mm_set1_epi16(static_cast<short>(slot + 1));
    const __m128i low = _mm_loadu_si128(reinterpret_cast<const __m128i*>(table));
    const __m128i high = _mm_loadu_si128(reinterpret_cast<const __m128i*>(table + 8));
    const __m128i below = _mm_packs_epi16(_mm_cmpgt_epi16(wanted, low), _mm_cmpgt_epi16(wanted, high));
    const auto mask = static_cast<unsigned>(_mm_movemask_epi8(below));  // ones from the lowest bit on
    return static_cast<unsigned>(__builtin_ctz(mask + 1)) - 1;
#else
    unsigned found = 0;
    for (unsigned j = 1; j < kPackedSymbols; ++j) found += table[j] <= slot ? 1U : 0U;
    return found;
#endif
  }

  std::uint32_t state_[2] = {kLeastState, kLeastState};
  StreamWords words_;
};

/// What coded values are decoded by.
struct CoderContexts {
  const std::uint16_t* tables = nullptr;  ///< of the first context
  bool bands = false;                     ///< a set of levels for each band
};

}  // namespace weir
