// How streams are written from the codes of their values: one thread per block runs the entropy coder, then one warp
// per block puts its bytes in place. Word by word as ValueEncoder::encode() of value_encoder.h. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "gpu/cuda/encode/code_steps.h"
#include "gpu/cuda/encode/word_writer.h"

namespace weir {
namespace encode_detail {

WEIR_HOST_DEVICE inline void put_code(const TransformCodes& codes, std::uint32_t code, std::uint32_t& x,
                                      WordWriter& words) {
  const std::uint32_t context = code & ((1U << kExtraShift) - 1U);
  const unsigned extra = code >> kExtraShift & 31U;
  const std::uint32_t m = code >> kMagnitudeShift;
  const std::uint32_t high = m >> extra;
  words.put_value(x, m, extra, codes.of[kPackedSymbols * context + (high < kEscape ? high : kEscape)]);
}

// Puts the values from the last place to the first.
template <bool kTwo>
WEIR_HOST_DEVICE void put_values(const TransformCodes& codes, const Quad* coded, unsigned end, std::uint32_t& first,
                                 std::uint32_t& second, WordWriter& words) {
  Quad next = coded[kEndUnit / 4 * end - 1];
  WEIR_NO_UNROLL
  for (unsigned q = kEndUnit / 4 * end; q > 0; --q) {
    const Quad quad = next;
    if (q > 1) next = coded[q - 2];
    WEIR_UNROLL
    for (unsigned k = 4; k > 0; --k) {
      if (q == 1 && k == 1) break;  // the mean's place
      put_code(codes, quad.of[k - 1], kTwo && k % 2 == 0 ? second : first, words);
    }
  }
}

// Returns byte `at` of a stream's bits, which begin after its first byte: a front of `bits`, then the early signs.
WEIR_HOST_DEVICE inline std::uint32_t front_byte(std::uint64_t head, std::uint32_t bits, const StreamState& state,
                                                 std::uint32_t early, std::uint32_t at) {
  const std::uint32_t first = 8 * at;
  std::uint32_t byte = first < 64 ? static_cast<std::uint32_t>(head >> first) & 0xFFU : 0U;
  if (first + 8 <= bits) return byte;
  const std::uint32_t skipped = first < bits ? bits - first : 0U;  // bits of this byte that belong to the head
  const std::uint32_t sign = first + skipped - bits;
  const std::uint32_t left = early > sign ? early - sign : 0U;
  const std::uint32_t room = 8 - skipped;
  byte |= sign_bits(state.signs, sign, left < room ? left : room) << skipped;
  return byte & 0xFFU;
}

}  // namespace encode_detail

/// Makes the words and states of ask `i`, if it is of a transform and code_block() has not left it to the host.
WEIR_HOST_DEVICE inline void put_words(const EncodeCall& call, const TransformCodes& codes, std::uint32_t i) {
  using namespace encode_detail;
  StreamState& state = call.states[i];
  if (call.asks[i].kind != StreamAskKind::transform || state.left != 0 || state.end == 0) return;
  const StreamParts parts = parts_of(state);
  std::uint32_t first = 0;
  std::uint32_t second = 0;
  begin_states(state, parts, first, second);
  WordWriter words(call.words + call.words_at(i), call.asks[i].bytes / 2);
  const auto* coded = reinterpret_cast<const Quad*>(call.coded + std::size_t{512} * i);
  if (parts.states == 2) {
    put_values<true>(codes, coded, state.end, first, second, words);
  } else {
    put_values<false>(codes, coded, state.end, first, second, words);
  }
  state.state[0] = first;
  state.state[1] = second;
  if (!words.fits()) state.left = 1;
  state.words = static_cast<std::uint16_t>(words.count());
}

/// Writes the bytes of ask `i`. If they are more than was asked for, the ask is left to the host.
template <class Warp>
WEIR_HOST_DEVICE void put_bytes(const Warp& warp, const EncodeCall& call, std::uint32_t i) {
  using namespace encode_detail;
  const StreamState& state = call.states[i];
  const StreamAsk ask = call.asks[i];
  std::byte* out = call.out + ask.offset;
  const auto kind = state.end == 0 ? PackedKind::mean : PackedKind::transform;
  const bool transformed = ask.kind == StreamAskKind::transform;
  const auto head_byte = static_cast<std::byte>(
      transformed ? static_cast<unsigned>(kind) | static_cast<unsigned>(ask.step - call.constants.coarsest) << 2U
                  : unsigned{state.head});
  // Minimum and quantum lie before the bits.
  const std::uint32_t bits_at = ask.kind == StreamAskKind::rounded ? kRoundedFrontBytes : 1;
  std::uint64_t head = state.number;
  std::uint32_t bits = state.number_bits;
  std::uint32_t early = 0;
  std::uint32_t back = 0;
  unsigned state_bytes[2] = {0, 0};
  if (state.end > 0) {
    const StreamParts parts = parts_of(state);
    head = transformed ? state.end - 1U : state.end;
    bits = transformed ? 5 : kLatticeEndBits;
    for (unsigned s = 0; s < parts.states; ++s) {
      state_bytes[s] = bytes_of_state(state.state[s]);
      head |= std::uint64_t{state_bytes[s] == 3 ? 1U : 0U} << bits++;
    }
    head |= std::uint64_t{state.number >> parts.moved} << bits;
    bits += state.number_bits - parts.moved;
    early = parts.early;
    back = 2U * state.words + state_bytes[0] + state_bytes[1];
  }
  const std::uint32_t front = bits_at + (bits + early + 7) / 8;
  // A mean's stream may be shorter than its bits, as the planned bytes of all.
  const bool fits = state.left == 0 && (state.end == 0 || front + back <= ask.bytes) &&
                    (ask.kind != StreamAskKind::exact || front + back == ask.bytes);
  const std::uint16_t* words = call.words + call.words_at(i);
  warp.each([&](unsigned lane) {
    if (lane == 0) call.made[i] = fits ? 1 : 0;
    if (!fits) return;
    for (std::uint32_t at = lane; at < ask.bytes; at += kLanes) {
      std::uint32_t byte = 0;
      if (at > 0 && at < bits_at) {
        std::uint32_t parameter;
        __builtin_memcpy(&parameter, &state.lattice[(at - 1) / 4], sizeof parameter);
        byte = parameter >> (8 * ((at - 1) % 4)) & 0xFFU;
      } else if (at > 0 && at < front) {
        byte = front_byte(head, bits, state, early, at - bits_at);
      } else if (at + back >= ask.bytes) {
        const std::uint32_t behind = at + back - ask.bytes;
        const std::uint32_t of_states = behind - 2U * state.words;
        if (behind < 2U * state.words) {
          byte = words[behind / 2] >> (8 * (behind % 2)) & 0xFFU;
        } else if (of_states < state_bytes[1]) {
          byte = state.state[1] >> (8 * of_states) & 0xFFU;
        } else {
          byte = state.state[0] >> (8 * (of_states - state_bytes[1])) & 0xFFU;
        }
      }
      out[at] = at == 0 ? head_byte : static_cast<std::byte>(byte);
    }
  });
}

}  // namespace weir
