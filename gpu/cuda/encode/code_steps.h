// The first step of encoding: how a warp quantises a block at its step, finds the code of each value, and makes the
// values that the stream decodes to. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_decode.h"
#include "gpu/cuda/encode/sign_bits.h"
#include "gpu/cuda/encode/survey_steps.h"

namespace weir {
namespace encode_detail {

using decode_detail::Quad;

// Parts of a code: context | extra bits << kExtraShift | magnitude << kMagnitudeShift.
inline constexpr unsigned kExtraShift = 7;
inline constexpr unsigned kMagnitudeShift = 12;
// Larger magnitudes, which no ladder's steps have, are left to the host.
inline constexpr std::uint32_t kMostCoded = (1U << (32 - kMagnitudeShift)) - 1;
static_assert(kPackedBands * kPackedLevels <= 1U << kExtraShift);
static_assert(kMostCoded > kMostMagnitude && kMostCoded <= kMostOfNeighbour);

// A warp's shared memory.
struct alignas(16) CodeStage {
  float values[kStageWords];
  std::uint32_t magnitudes[520];  // by index; index 512 stands for a missing neighbour
  std::uint32_t signs[17];
};

// Consecutive places of a lane.
inline constexpr unsigned kOwnPlaces = 512 / kLanes;

WEIR_HOST_DEVICE inline bool is_negative(float v) {
  std::uint32_t bits;
  __builtin_memcpy(&bits, &v, sizeof bits);
  return bits >> 31U != 0;
}

// Fills the magnitudes. Returns the last place that is not zero, or more than any place if a magnitude is too large.
template <class Warp>
WEIR_HOST_DEVICE std::uint32_t fill_magnitudes(const Warp& warp, const CostTables& tables, float step,
                                               CodeStage& stage) {
  typename Warp::template Own<std::uint32_t> last;
  const float scale = 1.0F / step;
  warp.each([&](unsigned lane) {
    std::uint32_t most = 0;
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      const unsigned index = lane + kLanes * k;
      const std::uint32_t m = magnitude_at(stage.values[stage_of(index)], scale);
      stage.magnitudes[index] = m;
      const std::uint32_t place = m == 0 ? 0U : m > kMostCoded ? 512U : tables.place[index] & 511U;
      most = place > most ? place : most;
    }
    last(lane) = most;
    if (lane < 8) stage.magnitudes[512 + lane] = 0;
    if (lane < 17) stage.signs[lane] = 0;
  });
  return warp.of_all(last, [](std::uint32_t a, std::uint32_t b) { return b > a ? b : a; });
}

// Returns the sum of the magnitudes beside the one at a place (block_scan.h). The magnitude at index 0 counts as 0.
WEIR_HOST_DEVICE inline std::uint32_t sum_beside(const CodeStage& stage, unsigned place, unsigned index) {
  const std::uint32_t* m = stage.magnitudes;
  if (place < 4) return (place > 1 ? m[1] : 0) + (place > 2 ? m[8] : 0);
  const unsigned up = index >= 64 ? index - 64 : 512;
  const unsigned left = (index & 56U) != 0 ? index - 8 : 512;
  const unsigned back = (index & 7U) != 0 ? index - 1 : 512;
  return m[up] + m[left] + m[back];
}

WEIR_HOST_DEVICE inline std::uint32_t code_of(const CostTables& tables, const CodeStage& stage, unsigned place,
                                              unsigned index) {
  const std::uint32_t known = tables.place[index];
  const std::uint32_t t = sum_beside(stage, place, index) * (known >> 9U & 7U);
  const std::uint32_t context = (known >> 12U) * kPackedLevels + tables.level_of(t);
  return context | extra_bits(t) << kExtraShift | stage.magnitudes[index] << kMagnitudeShift;
}

// Writes the codes of places below `limit`, and joins their signs. Returns the number of signs.
template <class Warp>
WEIR_HOST_DEVICE std::uint32_t write_codes(const Warp& warp, const CostTables& tables, unsigned limit, CodeStage& stage,
                                           std::uint32_t* codes) {
  typename Warp::template Own<std::uint32_t> signs, count;
  warp.each([&](unsigned lane) {
    if (kOwnPlaces * lane >= limit) return;
    std::uint32_t held = 0;
    std::uint32_t bits = 0;
    WEIR_UNROLL
    for (unsigned q = 0; q < kOwnPlaces / 4; ++q) {
      Quad quad;
      WEIR_UNROLL
      for (unsigned k = 0; k < 4; ++k) {
        const unsigned place = kOwnPlaces * lane + 4 * q + k;
        const unsigned index = tables.index[place];
        const std::uint32_t code = place == 0 ? 0U : code_of(tables, stage, place, index);
        quad.of[k] = code;
        const std::uint32_t coded = code >> kMagnitudeShift != 0 ? 1U : 0U;
        if (coded != 0 && is_negative(stage.values[stage_of(index)])) held |= 1U << bits;
        bits += coded;
      }
      reinterpret_cast<Quad*>(codes)[kOwnPlaces / 4 * lane + q] = quad;
    }
    signs(lane) = held;
    count(lane) = bits;
  });
  return join_signs(warp, signs, count, stage.signs);
}

// Turns coefficients into those that the stream decodes to, and these into values.
template <class Warp>
WEIR_HOST_DEVICE void decode_stage(const Warp& warp, const BlockConstants& constants, float step, float mean,
                                   CodeStage& stage, float* out) {
  using namespace packed_detail;
  warp.each([&](unsigned lane) {
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      const unsigned index = lane + kLanes * k;
      float& v = stage.values[stage_of(index)];
      const float c = coefficient(stage.magnitudes[index], constants, step);
      v = is_negative(v) ? -c : c;
    }
  });
  const auto line = [](float(&values)[8]) { inverse_transform_8(values); };
  warp.each([&](unsigned lane) { for_lane_lines<2>(stage.values, lane, line); });
  warp.each([&](unsigned lane) { for_lane_lines<1>(stage.values, lane, line); });
  warp.each([&](unsigned lane) { for_lane_lines<0>(stage.values, lane, line); });
  warp.each([&](unsigned lane) {
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      const unsigned index = lane + kLanes * k;
      out[index] = clamp_to(constants, mean + stage.values[stage_of(index)]);
    }
  });
}

}  // namespace encode_detail

/// Makes the state, codes and decoded values of ask `i` of the call if it is of a transform.
template <class Warp>
WEIR_HOST_DEVICE void code_block(const Warp& warp, const EncodeCall& call, const CostTables& tables, std::uint32_t i,
                                 encode_detail::CodeStage& stage) {
  using namespace encode_detail;
  const StreamAsk ask = call.asks[i];
  if (ask.kind != StreamAskKind::transform) return;
  StreamState& state = call.states[i];
  float* decoded = call.decoded + std::size_t{512} * i;
  gather_block(warp, call.box, ask.block, stage.values);
  const ValueRange8 range = range_of_block(warp, stage.values);
  const unsigned number_bits = mean_bits(ask.means, ask.step);
  std::uint32_t last = 512;
  const float step = step_size(ask.step);
  if (range.transformed && number_bits != kNoMeanBits) {
    transform_stage(warp, range.mean, stage.values);
    last = fill_magnitudes(warp, tables, step, stage);
  }
  const bool left = last > 511;
  const unsigned end = left || last == 0 ? 0 : last / kEndUnit + 1;
  std::uint32_t number = 0;
  std::uint32_t nonzero = 0;
  if (!left) {
    number = mean_code(ask.means, ask.step, range.mean);
    const float mean = decode_mean(ask.means, ask.step, number);
    if (end > 0) {
      nonzero = write_codes(warp, tables, kEndUnit * end, stage, call.coded + std::size_t{512} * i);
      decode_stage(warp, call.constants, step, mean, stage, decoded);
    } else {
      const float value = packed_detail::clamp_to(call.constants, mean);
      warp.each([&](unsigned lane) {
        for (unsigned k = 0; k < 16; ++k) decoded[lane + kLanes * k] = value;
      });
    }
  }
  warp.each([&](unsigned lane) {
    if (lane < 16) state.signs[lane] = stage.signs[lane];
    if (lane > 0) return;
    state.number = number;
    state.nonzero = static_cast<std::uint16_t>(nonzero);
    state.end = static_cast<std::uint8_t>(end);
    state.number_bits = static_cast<std::uint8_t>(number_bits);
    state.left = left ? 1 : 0;
  });
}

}  // namespace weir
