// How a warp finds the bytes and errors of a block's near rungs. Operation by operation as RoundedBlock::set() and
// cost() of rounded_block.h. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/near_rungs.h"
#include "format/packed/stream_length.h"
#include "gpu/cuda/encode/residual_stream.h"
#include "gpu/cuda/encode/rung_search.h"
#include "gpu/cuda/encode/symbol_sums.h"
#include "gpu/cuda/encode/transform_steps.h"

namespace weir {
namespace encode_detail {

// Returns 2^exponent as a normal double.
WEIR_HOST_DEVICE inline double wide_power_of_two(std::int32_t exponent) {
  const auto bits = static_cast<std::uint64_t>(1023 + exponent) << 52U;
  double power;
  __builtin_memcpy(&power, &bits, sizeof power);
  return power;
}

// Returns the integer nearest to a value in quanta.
WEIR_HOST_DEVICE inline std::int32_t multiple_of(double scaled) {
  return static_cast<std::int32_t>(scaled + (scaled < 0 ? -0.5 : 0.5));
}

// What is known of a block's values.
struct NearValues {
  float low = 0;
  float high = 0;
  std::uint32_t zeros = 0;
  std::int32_t exponent = 0;
  bool finite = false;  // all values are finite; otherwise the rest means nothing
};

template <class Warp>
WEIR_HOST_DEVICE NearValues near_values(const Warp& warp, const float* stage) {
  typename Warp::template Own<float> low, high;
  typename Warp::template Own<std::uint32_t> zeros, others;
  warp.each([&](unsigned lane) {
    float least = stage[stage_of(lane)];
    float most = least;
    std::uint32_t none = 0;
    std::uint32_t bad = 0;
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      const float v = stage[stage_of(lane + kLanes * k)];
      least = v < least ? v : least;
      most = v > most ? v : most;
      none += v == 0 ? 1U : 0U;
      bad += v - v == 0 ? 0U : 1U;
    }
    low(lane) = least;
    high(lane) = most;
    zeros(lane) = none;
    others(lane) = bad;
  });
  NearValues values;
  values.low = warp.of_all(low, [](float a, float b) { return b < a ? b : a; });
  values.high = warp.of_all(high, [](float a, float b) { return b > a ? b : a; });
  const auto sum = [](std::uint32_t a, std::uint32_t b) { return a + b; };
  values.zeros = warp.of_all(zeros, sum);
  values.finite = warp.of_all(others, sum) == 0;
  const float below = values.low < 0 ? -values.low : values.low;
  const float above = values.high < 0 ? -values.high : values.high;
  values.exponent = rounded_exponent(below > above ? below : above);
  return values;
}

// How the values are counted in quanta.
struct NearQuantum {
  double scale = 0;  // quanta per 1
  std::int32_t lowest = 0;
  bool fits = false;  // the lattice exists
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
WEIR_HOST_DEVICE void fill_codes(const Warp& warp, const NearQuantum& quantum, LatticeStage& stage) {
  warp.each([&](unsigned lane) {
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      const unsigned at = stage_of(lane + kLanes * k);
      const std::int32_t m = multiple_of(static_cast<double>(stage.values[at]) * quantum.scale);
      stage.codes[at] = static_cast<std::uint32_t>(m - quantum.lowest);
    }
  });
}

// Returns the best predictor for the values rounded to the usual number of bits. Leaves codes on the stage.
template <class Warp>
WEIR_HOST_DEVICE unsigned rounded_predictor(const Warp& warp, const NearValues& values, LatticeStage& stage) {
  const NearQuantum usual = near_quantum(values, values.exponent - kUsualRoundedBits);
  if (!usual.fits) return 0;
  fill_codes(warp, usual, stage);
  return choose_predictor<std::int32_t>(warp, stage.codes, false);
}

// Returns the bytes of a stream of the residuals. The last residual that is not 0 is at place `last` > 0.
template <class Warp>
WEIR_HOST_DEVICE std::uint32_t rounded_bytes(const Warp& warp, const CostTables& tables, const std::uint32_t* residuals,
                                             std::uint32_t last) {
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
      add_value(tables, kLatticeSymbol, sizes_beside(residuals, index, ~0U) * (known >> 9U & 7U),
                size_of_residual(residuals[stage_of(index)]), sums);
    }
    if (lane == 0) {
      add_first_places(
          tables, [&](unsigned index) { return size_of_residual(residuals[stage_of(index)]); },
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
      coded_stream_bits(all_symbols, all_raw, all_nonzero, end, kLatticeEndBits, kRoundedNumberBits) +
      kRoundedNumberBits;
  return kRoundedFrontBytes + (bits + 7) / 8;
}

// Calculates the squared errors of near rungs [first, first + kRungsAtOnce) in squared quanta, one rung per group of
// lanes.
template <class Warp>
WEIR_HOST_DEVICE void near_errors(const Warp& warp, const LatticeStage& stage, const NearValues& values,
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

/// Calculates the costs of the near rungs of a block of the call, if the survey has found some.
template <class Warp>
WEIR_HOST_DEVICE void survey_near_rungs(const Warp& warp, const NearCall& call, const CostTables& tables,
                                        std::uint32_t block, encode_detail::LatticeStage& stage) {
  using namespace encode_detail;
  const NearAsk& ask = call.ask.near;
  const std::uint32_t most = ask.most();
  NearCost* costs = call.costs + std::size_t{most} * block;
  warp.each([&](unsigned lane) {
    if (lane < most) costs[lane] = {};
  });
  const BlockFigures& known = call.figures[block];
  if (known.transformed == 0 || known.lattice != 0 || !(known.energy > 0)) return;
  gather_block(warp, call.box, block, stage.values);
  const NearValues values = near_values(warp, stage.values);
  const bool sparse = 2 * values.zeros > 512;
  if (ask.blocks == NearBlocks::sparse && !sparse) return;
  const unsigned predictor = rounded_predictor(warp, values, stage);
  const std::int32_t coarsest = coarsest_near_exponent(values.exponent);
  const std::uint32_t first = ask.first(coarsest);
  constexpr std::uint32_t kAtOnce = kLanes / kGroup;
  typename Warp::template Own<double> errors;
  std::uint32_t first_error = most;  // first of the kAtOnce rungs whose errors the lanes hold
  const auto look_at = [&](std::uint32_t k) {
    warp.each([](unsigned) {});  // waits until all lanes have read the costs; one cost is written next
    if (k - first_error >= kAtOnce) {
      first_error = k < most - kAtOnce ? k / kAtOnce * kAtOnce : most - kAtOnce;
      near_errors(warp, stage, values, coarsest, first + first_error, errors);
    }
    const std::int32_t exponent = coarsest - static_cast<std::int32_t>(first + k);
    const NearQuantum quantum = near_quantum(values, exponent);
    std::uint32_t bytes = kRawStreamBytes;
    if (quantum.fits) {
      fill_codes(warp, quantum, stage);
      const FoundResiduals found = find_residuals<std::int32_t>(warp, tables, predictor, false, stage.codes);
      if (found.last != 0 && found.bits < kMostRoundedResidual) {
        bytes = rounded_bytes(warp, tables, stage.codes, found.last);
      }
    }
    warp.each([&](unsigned lane) {
      if (lane != kGroup * (k - first_error)) return;
      const double size = wide_power_of_two(exponent);
      costs[k] =
          bytes < kRawStreamBytes ? NearCost{errors(lane) * size * size, bytes, 0} : NearCost{0, kNoNearBytes, 0};
    });
  };
  const bool searches = call.ask.searches() && call.box.covers(block) && known.rungs > 0;
  if (!searches) {
    for (std::uint32_t k = 0; k < most; ++k) look_at(k);
  } else {
    const std::uint32_t start = static_cast<std::uint32_t>(near_rung_about(coarsest, ask.wanted)) - first;
    const RungCost& rung =
        call.rungs[std::size_t{call.ask.most()} * block + call.ask.start(known.first_step) - known.first_rung];
    const auto at = [&](std::uint32_t k) { return known_rung(costs[k]); };
    std::uint32_t next = start;
    look_at(next);
    const bool may_be_bought = !is_sure_to_lead(call.ask.keys, known_rung(rung), at(start));
    while (may_be_bought && (next = next_rung(call.ask.keys, known.energy, start, most, at)) != kNoRung) look_at(next);
  }
  const std::uint32_t ordered = ask.all || sparse ? encode_detail::ordered_bytes(warp, tables, *call.codes, stage) : 0U;
  warp.each([&](unsigned lane) {
    if (lane > 0) return;
    call.figures[block].ordered_bytes = static_cast<std::uint16_t>(ordered);
    call.figures[block].first_near = static_cast<std::uint8_t>(first);
    call.figures[block].near = static_cast<std::uint8_t>(most);
  });
}

}  // namespace weir
