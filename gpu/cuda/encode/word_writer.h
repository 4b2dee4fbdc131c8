// The parts of a stream of coded values: words of the entropy coder, states, signs and a number. Word by word as
// ValueEncoder of value_encoder.h. For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "gpu/cuda/encode/encode_call.h"

namespace weir::encode_detail {

// Returns `count` <= 32 bits of words from bit `first` on. Bits beyond the last of the 16 words are zero.
WEIR_HOST_DEVICE inline std::uint32_t sign_bits(const std::uint32_t* words, std::uint32_t first, std::uint32_t count) {
  const std::uint32_t at = first / 32;
  const std::uint32_t low = at < 16 ? words[at] : 0U;
  const std::uint32_t high = at + 1 < 16 ? words[at + 1] : 0U;
  const std::uint64_t two = low | std::uint64_t{high} << 32U;
  return static_cast<std::uint32_t>(two >> (first % 32) & ((std::uint64_t{1} << count) - 1));
}

// The layout of a stream that has values.
struct StreamParts {
  unsigned states;
  std::uint32_t late;   // number of signs in the initial states
  std::uint32_t moved;  // number of low bits of the number in the initial states
  std::uint32_t early;  // number of signs in front
};

WEIR_HOST_DEVICE inline StreamParts parts_of(const StreamState& state) {
  StreamParts parts;
  parts.states = states_of(state.end);
  const std::uint32_t capacity = 16 * parts.states;
  parts.late = state.nonzero < capacity ? state.nonzero : capacity;
  const std::uint32_t rest = capacity - parts.late;
  parts.moved = rest < state.number_bits ? rest : state.number_bits;
  parts.early = state.nonzero - parts.late;
  return parts;
}

// Returns the states with which the coding of a stream begins.
WEIR_HOST_DEVICE inline void begin_states(const StreamState& state, const StreamParts& parts, std::uint32_t& first,
                                          std::uint32_t& second) {
  std::uint32_t payload = sign_bits(state.signs, parts.early, parts.late);
  // Without late signs, all 32 bits may belong to the number.
  if (parts.moved == 32) payload = state.number;
  if (parts.moved > 0 && parts.moved < 32) payload |= (state.number & ((1U << parts.moved) - 1U)) << parts.late;
  first = kLeastState | (payload & 0xFFFFU);
  second = kLeastState | payload >> 16U;
}

// Writes words in the order in which they are made, as many as fit.
class WordWriter {
 public:
  WEIR_HOST_DEVICE WordWriter(std::uint16_t* words, std::uint32_t most) : words_(words), most_(most) {}

  WEIR_HOST_DEVICE void put_symbol(std::uint32_t& x, const SymbolCode& symbol) {
    if (x >= std::uint64_t{symbol.frequency} << (32U - kFrequencyBits)) emit(x);
    const auto whole = static_cast<std::uint32_t>(x * symbol.inverse >> kSymbolInverseBits);
    x = (whole << kFrequencyBits) + (x - whole * symbol.frequency) + symbol.low;
  }
  WEIR_HOST_DEVICE void put_raw(std::uint32_t& x, std::uint32_t value, unsigned bits) {
    if (bits == 0) return;
    if (x >> (32U - bits) != 0) emit(x);
    x = x << bits | value;
  }
  WEIR_HOST_DEVICE void put_escape(std::uint32_t& x, std::uint32_t high) {
    const std::uint32_t over = high - (kEscape - 1);
    const unsigned length = 31U - static_cast<unsigned>(__builtin_clz(over));
    const std::uint32_t rest = over - (1U << length);
    if (length > 16) put_raw(x, rest >> 16U, length - 16);
    put_raw(x, rest & 0xFFFFU, length < 16 ? length : 16U);
    put_raw(x, length, 5);
  }
  /// Puts a magnitude with `extra` raw bits. The part that is decoded last is put first.
  WEIR_HOST_DEVICE void put_value(std::uint32_t& x, std::uint32_t m, unsigned extra, const SymbolCode& symbol) {
    const std::uint32_t high = m >> extra;
    put_raw(x, m & ((1U << extra) - 1U), extra);
    if (high >= kEscape) put_escape(x, high);
    put_symbol(x, symbol);
  }
  /// Returns the number of words that were made. It exceeds the room if fits() is false.
  WEIR_HOST_DEVICE std::uint32_t count() const { return count_; }
  WEIR_HOST_DEVICE bool fits() const { return count_ <= most_; }

 private:
  WEIR_HOST_DEVICE void emit(std::uint32_t& x) {
    if (count_ < most_) words_[count_] = static_cast<std::uint16_t>(x);
    ++count_;
    x >>= 16U;
  }

  std::uint16_t* words_;
  std::uint32_t most_;
  std::uint32_t count_ = 0;
};

WEIR_HOST_DEVICE inline unsigned bytes_of_state(std::uint32_t x) { return x >> 24U == 0 ? 3 : 4; }

}  // namespace weir::encode_detail
