// How a warp codes the residuals of a block on a lattice, or of ordered floats: all lanes find the symbols, and one
// lane runs the entropy coder. Word by word as ValueEncoder::encode() of value_encoder.h. For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/stream_length.h"
#include "gpu/cuda/encode/residual_steps.h"
#include "gpu/cuda/encode/sign_bits.h"
#include "gpu/cuda/encode/word_writer.h"

namespace weir::encode_detail {

// Parts of a symbol: 16 levels of symbols | extra bits << kRawShift.
inline constexpr unsigned kRawShift = 9;
static_assert(kPackedLevels * kPackedSymbols <= 1U << kRawShift);

// Finds the symbols of residuals at places below `limit`, and joins their signs. Returns the number of signs.
template <class Warp>
WEIR_HOST_DEVICE std::uint32_t find_symbols(const Warp& warp, const CostTables& tables, unsigned limit,
                                            LatticeStage& stage) {
  typename Warp::template Own<std::uint32_t> signs, count;
  constexpr unsigned kOwn = 512 / kLanes;  // consecutive places of a lane
  warp.each([&](unsigned lane) {
    if (lane < 17) stage.signs[lane] = 0;
    std::uint32_t held = 0;
    std::uint32_t bits = 0;
    WEIR_NO_UNROLL
    for (unsigned k = 0; k < kOwn && kOwn * lane < limit; ++k) {
      const unsigned place = kOwn * lane + k;
      if (place == 0) continue;
      const unsigned index = tables.index[place];
      const std::uint32_t residual = stage.codes[stage_of(index)];
      const std::uint32_t m = size_of_residual(residual);
      const auto first = [&](unsigned at) {
        const std::uint32_t size = size_of_residual(stage.codes[stage_of(at)]);
        return size < kMostOfNeighbour ? size : kMostOfNeighbour;
      };
      const std::uint32_t beside = place < 4 ? (place > 1 ? first(1) : 0U) + (place > 2 ? first(8) : 0U)
                                             : sizes_beside(stage.codes, index, kMostOfNeighbour);
      const std::uint32_t t = beside * (tables.place[index] >> 9U & 7U);
      const unsigned extra = extra_bits(t);
      const std::uint32_t high = m >> extra;
      stage.symbols[place] = static_cast<std::uint16_t>(kPackedSymbols * tables.level_of(t) +
                                                        (high < kEscape ? high : kEscape) + (extra << kRawShift));
      const std::uint32_t coded = m != 0 ? 1U : 0U;
      held |= (residual >> 31U & coded) << bits;
      bits += coded;
    }
    signs(lane) = held;
    count(lane) = bits;
  });
  return join_signs(warp, signs, count, stage.signs);
}

// Puts the residuals from the last place to the first.
template <bool kTwo>
WEIR_HOST_DEVICE void put_residuals(const CostTables& tables, const CodeTables& codes, const LatticeStage& stage,
                                    unsigned end, std::uint32_t& first, std::uint32_t& second, WordWriter& words) {
  WEIR_NO_UNROLL
  for (unsigned place = kEndUnit * end - 1; place > 0; --place) {
    const std::uint32_t symbol = stage.symbols[place];
    words.put_value(kTwo && place % 2 == 1 ? second : first,
                    size_of_residual(stage.codes[stage_of(tables.index[place])]), symbol >> kRawShift,
                    codes.lattice[symbol & ((1U << kRawShift) - 1U)]);
  }
}

// Called by one lane: makes the words and states of a stream. The rest of `state` is complete.
WEIR_HOST_DEVICE inline void code_residuals(const CostTables& tables, const CodeTables& codes,
                                            const LatticeStage& stage, const StreamParts& parts, StreamState& state,
                                            WordWriter& words) {
  std::uint32_t first = 0;
  std::uint32_t second = 0;
  begin_states(state, parts, first, second);
  if (parts.states == 2) {
    put_residuals<true>(tables, codes, stage, state.end, first, second, words);
  } else {
    put_residuals<false>(tables, codes, stage, state.end, first, second, words);
  }
  state.state[0] = first;
  state.state[1] = second;
  state.words = static_cast<std::uint16_t>(words.count());
}

// Makes codes of the values as ordered floats.
template <class Warp>
WEIR_HOST_DEVICE void fill_ordered(const Warp& warp, LatticeStage& stage) {
  warp.each([&](unsigned lane) {
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      const unsigned at = stage_of(lane + kLanes * k);
      stage.codes[at] = ordered_of_float(stage.values[at]);
    }
  });
}

// Returns the bytes of the stream of the stage's values as ordered floats, at most kRawStreamBytes. The values lie on
// no lattice and are not all the same. As encode_exact() of lattice_block.h.
template <class Warp>
WEIR_HOST_DEVICE std::uint32_t ordered_bytes(const Warp& warp, const CostTables& tables, const CodeTables& codes,
                                             LatticeStage& stage) {
  fill_ordered(warp, stage);
  const std::uint32_t number = stage.codes[0];
  const unsigned predictor = choose_predictor<std::int64_t>(warp, stage.codes, true);
  const FoundResiduals found = find_residuals<std::int64_t>(warp, tables, predictor, true, stage.codes);
  const unsigned end = found.last / kEndUnit + 1;
  const std::uint32_t nonzero = find_symbols(warp, tables, kEndUnit * end, stage);
  typename Warp::template Own<std::uint32_t> bytes;
  warp.each([&](unsigned lane) {
    if (lane > 0) return;
    StreamState state;
    for (unsigned i = 0; i < 16; ++i) state.signs[i] = stage.signs[i];
    state.number = number;
    state.number_bits = kOrderedNumberBits;
    state.nonzero = static_cast<std::uint16_t>(nonzero);
    state.end = static_cast<std::uint8_t>(end);
    const StreamParts parts = parts_of(state);
    WordWriter words(nullptr, 0);
    code_residuals(tables, codes, stage, parts, state, words);
    const std::uint32_t front = kLatticeEndBits + parts.states + kOrderedNumberBits - parts.moved + parts.early;
    std::uint32_t back = 2 * words.count() + bytes_of_state(state.state[0]);
    if (parts.states == 2) back += bytes_of_state(state.state[1]);
    bytes(lane) = 1 + (front + 7) / 8 + back;
  });
  const std::uint32_t all = warp.of_all(bytes, [](std::uint32_t a, std::uint32_t b) { return b > a ? b : a; });
  return all < kRawStreamBytes ? all : kRawStreamBytes;
}

}  // namespace weir::encode_detail
