// The parts that the decoders of a packed block's coded values share: interleaved rANS over contexts of decoded
// neighbours (FORMAT.md, "Coded values"; Duda 2013, Giesen 2014). For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_constants.h"
#include "format/packed/block_context.h"
#include "format/packed/block_scan.h"

namespace weir {

inline constexpr std::uint32_t kLeastState = 65536;
/// The number of coefficients per unit of `end`.
inline constexpr unsigned kEndUnit = 16;
/// Streams with at most this `end` have one state, others two.
inline constexpr unsigned kOneStateEnd = 8;
inline constexpr unsigned kEscape = kPackedSymbols - 1;

WEIR_HOST_DEVICE inline unsigned states_of(unsigned end) { return end <= kOneStateEnd ? 1 : 2; }

/// Reads bits of a stream, the lowest of each byte first. Bits beyond the stream's end are zeros; bytes_used() then
/// exceeds the stream's bytes.
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
  /// The bits, and the whole bytes, that have been read.
  WEIR_HOST_DEVICE std::uint32_t bits_used() const { return at_; }
  WEIR_HOST_DEVICE std::uint32_t bytes_used() const { return (at_ + 7) >> 3U; }

 private:
  const std::byte* bytes_;
  std::uint32_t count_;
  std::uint32_t at_ = 0;
};

/// The states of a stream before its first value, and the position of its words.
class StreamStates {
 public:
  /// Reads the states. Returns false if the stream is too short.
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
    at_ = at;
    return true;
  }

  WEIR_HOST_DEVICE std::uint32_t state(unsigned s) const { return state_[s]; }
  /// Returns the end of the words, which are read from the last one on.
  WEIR_HOST_DEVICE const std::byte* at() const { return at_; }

 private:
  std::uint32_t state_[2] = {kLeastState, kLeastState};
  const std::byte* at_ = nullptr;
};

/// The tables that coded values are decoded with.
struct CoderContexts {
  const std::uint16_t* tables = nullptr;  ///< tables of the first context
  bool bands = false;                     ///< a set of levels for each band
};

}  // namespace weir
