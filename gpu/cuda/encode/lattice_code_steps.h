// How a warp codes a block whose values are rounded, or kept as ordered floats, and makes the values that the stream
// decodes to. Word by word as RoundedBlock::encode() of rounded_block.h and encode_exact() of lattice_block.h. For
// host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_decode.h"
#include "gpu/cuda/encode/lattice_steps.h"
#include "gpu/cuda/encode/near_steps.h"

namespace weir {
namespace encode_detail {

// How the codes of a stage are written.
struct LatticeCoding {
  unsigned predictor = 0;
  std::uint32_t number = 0;
  unsigned number_bits = 0;
  std::uint32_t last = 0;  // last place with a residual; 0: no place has one
  float minimum = 0;
  float quantum = 0;
};

// Makes codes of the values in multiples of a quantum, then residuals. Returns false if no such lattice exists.
template <class Warp>
WEIR_HOST_DEVICE bool code_rounded(const Warp& warp, const EncodeCall& call, const CostTables& tables,
                                   const NearValues& values, std::int32_t exponent, LatticeStage& stage, float* decoded,
                                   LatticeCoding& coding) {
  const NearQuantum quantum = near_quantum(values, exponent);
  if (!quantum.fits) return false;
  coding.predictor = rounded_predictor(warp, values, stage);
  fill_codes(warp, quantum, stage);
  coding.number = stage.codes[0];
  coding.number_bits = kRoundedNumberBits;
  coding.quantum = static_cast<float>(wide_power_of_two(exponent));
  coding.minimum = static_cast<float>(quantum.lowest) * coding.quantum;
  warp.each([&](unsigned lane) {
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      const unsigned index = lane + kLanes * k;
      decoded[index] =
          packed_detail::lattice_value(call.constants, coding.minimum, coding.quantum, stage.codes[stage_of(index)]);
    }
  });
  coding.last = find_residuals<std::int32_t>(warp, tables, coding.predictor, false, stage.codes).last;
  return true;
}

// Makes codes of the values as ordered floats, then residuals. Returns false if the values may lie on a lattice,
// which takes fewer bytes.
template <class Warp>
WEIR_HOST_DEVICE bool code_ordered(const Warp& warp, const CostTables& tables, const NearValues& values,
                                   LatticeStage& stage, float* decoded, LatticeCoding& coding) {
  if (!(values.low < values.high)) return false;
  if (may_lie_on_lattice(warp, {values.low, values.high, 0, true}, stage.values)) return false;
  fill_ordered(warp, stage);
  coding.number = stage.codes[0];
  coding.number_bits = kOrderedNumberBits;
  coding.predictor = choose_predictor<std::int64_t>(warp, stage.codes, true);
  warp.each([&](unsigned lane) {
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      const unsigned index = lane + kLanes * k;
      decoded[index] = stage.values[stage_of(index)];
    }
  });
  coding.last = find_residuals<std::int64_t>(warp, tables, coding.predictor, true, stage.codes).last;
  return true;
}

}  // namespace encode_detail

/// Makes the state, words and decoded values of ask `i` of the call, which is not of a transform.
template <class Warp>
WEIR_HOST_DEVICE void code_lattice_block(const Warp& warp, const EncodeCall& call, const CostTables& tables,
                                         std::uint32_t i, encode_detail::LatticeStage& stage) {
  using namespace encode_detail;
  const StreamAsk ask = call.asks[i];
  StreamState& state = call.states[i];
  float* decoded = call.decoded + std::size_t{512} * i;
  gather_block(warp, call.box, ask.block, stage.values);
  const NearValues values = near_values(warp, stage.values);
  const bool rounded = ask.kind == StreamAskKind::rounded;
  LatticeCoding coding;
  bool left = !values.finite;
  if (!left && rounded) left = !code_rounded(warp, call, tables, values, ask.step, stage, decoded, coding);
  if (!left && !rounded) left = !code_ordered(warp, tables, values, stage, decoded, coding);
  std::uint32_t nonzero = 0;
  const unsigned end = coding.last / kEndUnit + 1;
  left = left || coding.last == 0;
  if (!left) nonzero = find_symbols(warp, tables, kEndUnit * end, stage);
  warp.each([&](unsigned lane) {
    if (!left && lane < 16) state.signs[lane] = stage.signs[lane];
  });
  warp.each([&](unsigned lane) {
    if (lane > 0) return;
    state.left = left ? 1 : 0;
    state.end = static_cast<std::uint8_t>(left ? 0 : end);
    if (left) return;
    const auto kind = rounded ? LatticeKind::own : LatticeKind::ordered;
    state.head = static_cast<std::uint8_t>(static_cast<unsigned>(PackedKind::lattice) | coding.predictor << 2U |
                                           static_cast<unsigned>(kind) << 4U);
    state.number = coding.number;
    state.number_bits = static_cast<std::uint8_t>(coding.number_bits);
    state.nonzero = static_cast<std::uint16_t>(nonzero);
    state.lattice[0] = coding.minimum;
    state.lattice[1] = coding.quantum;
    WordWriter words(call.words + call.words_at(i), ask.bytes / 2);
    code_residuals(tables, *call.codes, stage, parts_of(state), state, words);
    if (!words.fits()) state.left = 1;
  });
}

}  // namespace weir
