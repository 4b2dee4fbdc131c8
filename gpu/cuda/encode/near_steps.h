// How a warp finds what a block's near rungs take and lose: RoundedBlock::set() and cost() of rounded_block.h,
// operation by operation. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/lattice_codes.h"
#include "format/packed/near_rungs.h"
#include "format/packed/stream_length.h"
#include "gpu/cuda/encode/symbol_sums.h"
#include "gpu/cuda/encode/transform_steps.h"

namespace weir {
namespace encode_detail {

using decode_detail::kStageX;
using decode_detail::kStageY;

// What a warp has of shared memory.
struct alignas(16) NearStage {
  float values[kStageWords];         // where stage_of() says
  std::uint32_t codes[kStageWords];  // there too; then magnitudes of residuals
};

// 2^exponent, of a normal number.
WEIR_HOST_DEVICE inline double wide_power_of_two(std::int32_t exponent) {
  const auto bits = static_cast<std::uint64_t>(1023 + exponent) << 52U;
  double power;
  __builtin_memcpy(&power, &bits, sizeof power);
  return power;
}

// The whole number nearest to a value in quanta.
WEIR_HOST_DEVICE inline std::int32_t multiple_of(double scaled) {
  return static_cast<std::int32_t>(scaled + (scaled < 0 ? -0.5 : 0.5));
}

// What is known of a block's values.
struct NearValues {
  float low = 0;
  float high = 0;
  std::uint32_t zeros = 0;
  std::int32_t exponent = 0;
};

template <class Warp>
WEIR_HOST_DEVICE NearValues near_values(const Warp& warp, const float* stage) {
  typename Warp::template Own<float> low, high;
  typename Warp::template Own<std::uint32_t> zeros;
  warp.each([&](unsigned lane) {
    float least = stage[stage_of(lane)];
    float most = least;
    std::uint32_t none = 0;
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      const float v = stage[stage_of(lane + kLanes * k)];
      least = v < least ? v : least;
      most = v > most ? v : most;
      none += v == 0 ? 1U : 0U;
    }
    low(lane) = least;
    high(lane) = most;
    zeros(lane) = none;
  });
  NearValues values;
  values.low = warp.of_all(low, [](float a, float b) { return b < a ? b : a; });
  values.high = warp.of_all(high, [](float a, float b) { return b > a ? b : a; });
  values.zeros = warp.of_all(zeros, [](std::uint32_t a, std::uint32_t b) { return a + b; });
  const float below = values.low < 0 ? -values.low : values.low;
  const float above = values.high < 0 ? -values.high : values.high;
  values.exponent = rounded_exponent(below > above ? below : above);
  return values;
}

// The values in quanta.
struct NearQuantum {
  double scale = 0;  // quanta of 1
  std::int32_t lowest = 0;
  bool fits = false;  // there is such a lattice
};

WEIR_HOST_DEVICE inline NearQuantum near_quantum(const NearValues& values, std::int32_t exponent) {
  NearQuantum quantum;
  if (!is_quantum_exponent(exponent, values.exponent)) return quantum;
  quantum.scale = wide_power_of_two(-exponent);
  // Rounding keeps the order.
  quantum.lowest = multiple_of(static_cast<double>(values.low) * quantum.scale);
  const std::int32_t highest = multiple_of(static_cast<double>(values.high) * quantum.scale);
  quantum.fits = highest != quantum.lowest && highest - quantum.lowest < 1 << kRoundedNumberBits;
  return quantum;
}

template <class Warp>
WEIR_HOST_DEVICE void fill_codes(const Warp& warp, const NearQuantum& quantum, NearStage& stage) {
  warp.each([&](unsigned lane) {
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      const unsigned at = stage_of(lane + kLanes * k);
      const std::int32_t m = multiple_of(static_cast<double>(stage.values[at]) * quantum.scale);
      stage.codes[at] = static_cast<std::uint32_t>(m - quantum.lowest);
    }
  });
}

// Of a voxel: its code less what is predicted of those before it; 0 of the first.
template <class Sum>
WEIR_HOST_DEVICE inline std::uint32_t residual_at(const std::uint32_t* codes, unsigned predictor, bool ordered,
                                                  unsigned index) {
  if (index == 0) return 0;
  const std::uint32_t* at = codes + stage_of(index);
  return *at - static_cast<std::uint32_t>(predict_at<Sum, kStageX, kStageY>(predictor, ordered, at, index >= 64,
                                                                            (index & 56U) != 0, (index & 7U) != 0));
}

WEIR_HOST_DEVICE inline std::uint32_t size_of_residual(std::uint32_t residual) {
  return residual >> 31U != 0 ? 0U - residual : residual;
}

// best_predictor() of residuals.h.
template <class Sum, class Warp>
WEIR_HOST_DEVICE unsigned choose_predictor(const Warp& warp, const std::uint32_t* codes, bool ordered) {
  unsigned best = 0;
  std::uint32_t least = ~0U;
  typename Warp::template Own<std::uint32_t> bits;
  WEIR_NO_UNROLL
  for (unsigned predictor = 0; predictor < kPredictors; ++predictor) {
    warp.each([&](unsigned lane) {
      std::uint32_t sum = 0;
      WEIR_NO_UNROLL
      for (unsigned k = 0; k < 16; ++k) {
        const std::uint32_t m = 3U * size_of_residual(residual_at<Sum>(codes, predictor, ordered, lane + kLanes * k));
        sum += m == 0 ? 0U : 32U - static_cast<unsigned>(__builtin_clz(m));
      }
      bits(lane) = sum;
    });
    const std::uint32_t all = warp.of_all(bits, [](std::uint32_t a, std::uint32_t b) { return a + b; });
    if (all < least) {
      least = all;
      best = predictor;
    }
  }
  return best;
}

// Codes become magnitudes of residuals. Returns the last place that is not zero, and all bits of the magnitudes.
struct ResidualBits {
  std::uint32_t last = 0;
  std::uint32_t bits = 0;
};
struct OwnResiduals {
  std::uint32_t of[16];
};

template <class Sum, class Warp>
WEIR_HOST_DEVICE ResidualBits code_residuals(const Warp& warp, const CostTables& tables, unsigned predictor,
                                             bool ordered, std::uint32_t* codes) {
  typename Warp::template Own<OwnResiduals> own;
  typename Warp::template Own<std::uint32_t> last, bits;
  warp.each([&](unsigned lane) {
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      own(lane).of[k] = size_of_residual(residual_at<Sum>(codes, predictor, ordered, lane + kLanes * k));
    }
  });
  warp.each([&](unsigned lane) {
    std::uint32_t most = 0;
    std::uint32_t all = 0;
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      const unsigned index = lane + kLanes * k;
      const std::uint32_t m = own(lane).of[k];
      codes[stage_of(index)] = m;
      const std::uint32_t place = m == 0 ? 0U : tables.place[index] & 511U;
      most = place > most ? place : most;
      all |= m;
    }
    last(lane) = most;
    bits(lane) = all;
  });
  ResidualBits found;
  found.last = warp.of_all(last, [](std::uint32_t a, std::uint32_t b) { return b > a ? b : a; });
  found.bits = warp.of_all(bits, [](std::uint32_t a, std::uint32_t b) { return a | b; });
  return found;
}

// Bytes of a stream of those magnitudes, whose last one is at `last` > 0.
template <class Warp>
WEIR_HOST_DEVICE std::uint32_t rounded_bytes(const Warp& warp, const CostTables& tables,
                                             const std::uint32_t* magnitudes, std::uint32_t last) {
  typename Warp::template Own<std::uint32_t> symbols, raw, nonzero;
  const unsigned end = last / kEndUnit + 1;
  warp.each([&](unsigned lane) {
    SymbolSums sums;
    WEIR_NO_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      const unsigned index = lane + kLanes * k;
      const std::uint32_t known = tables.place[index];
      const unsigned place = known & 511U;
      if (place < 4 || place >= kEndUnit * end) continue;
      const std::uint32_t* at = magnitudes + stage_of(index);
      const std::uint32_t beside = (index >= 64 ? *(at - kStageX) : 0U) + ((index & 56U) != 0 ? *(at - kStageY) : 0U) +
                                   ((index & 7U) != 0 ? *(at - 1) : 0U);
      add_value(tables, kLatticeSymbol, beside * (known >> 9U & 7U), *at, sums);
    }
    if (lane == 0) {
      add_first_places(
          tables, [&](unsigned index) { return magnitudes[stage_of(index)]; },
          [](std::uint32_t) { return kLatticeSymbol; }, sums);
    }
    symbols(lane) = sums.symbols;
    raw(lane) = sums.raw;
    nonzero(lane) = sums.nonzero;
  });
  const auto sum = [](std::uint32_t a, std::uint32_t b) { return a + b; };
  const std::uint32_t all_symbols = warp.of_all(symbols, sum);
  const std::uint32_t all_raw = warp.of_all(raw, sum);
  const std::uint32_t all_nonzero = warp.of_all(nonzero, sum);
  const std::uint32_t bits =
      coded_stream_bits(all_symbols, all_raw, all_nonzero, end, kRoundedEndBits, kRoundedNumberBits) +
      kRoundedNumberBits;
  return kRoundedFrontBytes + (bits + 7) / 8;
}

// Squared errors of near rungs [first, first + kRungsAtOnce) in squared quanta, one a group of lanes.
template <class Warp>
WEIR_HOST_DEVICE void near_errors(const Warp& warp, const NearStage& stage, const NearValues& values,
                                  std::int32_t coarsest, std::uint32_t first,
                                  typename Warp::template Own<double>& errors) {
  typename Warp::template Own<double> own;
  warp.each([&](unsigned lane) {
    const NearQuantum quantum = near_quantum(values, coarsest - static_cast<std::int32_t>(first + lane / kGroup));
    double sum = 0;
    if (quantum.fits) {
      WEIR_NO_UNROLL
      for (unsigned row = 0; row < 64; ++row) {
        const double scaled = static_cast<double>(stage.values[stage_row(row) + lane % kGroup]) * quantum.scale;
        const double error = scaled - static_cast<double>(multiple_of(scaled));
        sum += error * error;
      }
    }
    own(lane) = sum;
  });
  warp.add_in_order(own, errors);
}

}  // namespace encode_detail

/// Costs of the near rungs of a block of the call that the survey has found to have some.
template <class Warp>
WEIR_HOST_DEVICE void survey_near_rungs(const Warp& warp, const NearCall& call, const CostTables& tables,
                                        std::uint32_t block, encode_detail::NearStage& stage) {
  using namespace encode_detail;
  const BlockFigures& known = call.figures[block];
  if (known.transformed == 0 || known.lattice != 0 || !(known.energy > 0)) return;
  gather_block(warp, call.box, block, stage.values);
  const NearValues values = near_values(warp, stage.values);
  if (call.ask.blocks == NearBlocks::sparse && !(2 * values.zeros > 512)) return;
  unsigned predictor = 0;
  const NearQuantum usual = near_quantum(values, values.exponent - kUsualRoundedBits);
  if (usual.fits) {
    fill_codes(warp, usual, stage);
    predictor = choose_predictor<std::int32_t>(warp, stage.codes, false);
  }
  const std::int32_t coarsest = coarsest_near_exponent(values.exponent);
  const std::uint32_t first = call.ask.first(coarsest);
  NearCost* costs = call.costs + std::size_t{call.ask.most()} * block;
  typename Warp::template Own<double> errors;
  constexpr std::uint32_t kAtOnce = kLanes / kGroup;
  for (std::uint32_t k = 0; k < call.ask.most(); ++k) {
    if (k % kAtOnce == 0) near_errors(warp, stage, values, coarsest, first + k, errors);
    const std::int32_t exponent = coarsest - static_cast<std::int32_t>(first + k);
    const NearQuantum quantum = near_quantum(values, exponent);
    std::uint32_t bytes = kRawStreamBytes;
    if (quantum.fits) {
      fill_codes(warp, quantum, stage);
      const ResidualBits found = code_residuals<std::int32_t>(warp, tables, predictor, false, stage.codes);
      if (found.last != 0 && found.bits < kMostRoundedResidual) {
        bytes = rounded_bytes(warp, tables, stage.codes, found.last);
      }
    }
    warp.each([&](unsigned lane) {
      if (lane != kGroup * (k % kAtOnce)) return;
      const double size = wide_power_of_two(exponent);
      costs[k] =
          bytes < kRawStreamBytes ? NearCost{errors(lane) * size * size, bytes, 0} : NearCost{0, kNoNearBytes, 0};
    });
  }
  warp.each([&](unsigned lane) {
    if (lane > 0) return;
    call.figures[block].first_near = static_cast<std::uint8_t>(first);
    call.figures[block].near = static_cast<std::uint8_t>(call.ask.most());
  });
}

}  // namespace weir
