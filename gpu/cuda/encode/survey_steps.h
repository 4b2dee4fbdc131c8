// How a warp surveys a block: its transform, then bits and squared error of rungs of the ladder, four rungs at a
// time, one per group of eight lanes. Operation by operation as TransformBlock::cost() of block_encode.h. For host
// and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/quantiser.h"
#include "format/packed/stream_length.h"
#include "gpu/cuda/encode/lattice_steps.h"
#include "gpu/cuda/encode/rung_search.h"
#include "gpu/cuda/encode/symbol_sums.h"
#include "gpu/cuda/encode/transform_steps.h"

namespace weir {
namespace encode_detail {

inline constexpr unsigned kRungsAtOnce = kLanes / kGroup;

// The rung that a group counts.
struct GroupRung {
  float step = 0;
  float scale = 0;
  bool counted = false;  // the rung exists and is neither too coarse nor too fine
  bool coded = false;    // its largest magnitude is not too large
};

// Returns the magnitude of a coefficient of any sign.
WEIR_HOST_DEVICE inline std::uint32_t magnitude_at(float coefficient, float scale) {
  const float size = coefficient < 0 ? -coefficient : coefficient;
  return static_cast<std::uint32_t>(magnitude_of(size * scale));
}

// Adds the coefficients at places [4, limit) of a lane's column.
WEIR_HOST_DEVICE inline SymbolSums add_column(const CostTables& tables, const float* stage, unsigned z, float scale,
                                              unsigned limit) {
  SymbolSums sums;
  std::uint32_t up[8] = {};
  WEIR_NO_UNROLL
  for (unsigned x = 0; x < 8; ++x) {
    std::uint32_t left = 0;
    WEIR_UNROLL
    for (unsigned y = 0; y < 8; ++y) {
      const unsigned row = 8 * x + y;
      const float* at = stage + stage_row(row) + z;
      const std::uint32_t m = magnitude_at(*at, scale);
      const std::uint32_t back = z > 0 ? magnitude_at(*(at - 1), scale) : 0;
      const std::uint32_t known = tables.place[8 * row + z];
      const unsigned place = known & 511U;
      if (place >= 4 && place < limit) {
        const std::uint32_t t = (up[y] + left + back) * (known >> 9U & 7U);
        add_value(tables, (known >> 12U) * kPackedLevels * kPackedSymbols, t, m, sums);
      }
      up[y] = m;
      left = m;
    }
  }
  return sums;
}

// The squared error of a lane's column in squared steps, the error that rows without a magnitude add to the block's,
// and the last place that is not zero.
struct ColumnError {
  float sum = 0;
  double dropped = 0;
  std::uint32_t last = 0;
};

WEIR_HOST_DEVICE inline ColumnError quantise_column(const CostTables& tables, const BlockStage& stage, unsigned z,
                                                    const GroupRung& rung) {
  const float least = least_of_row(rung.step);
  ColumnError error;
  WEIR_NO_UNROLL
  for (unsigned row = 0; row < 64; ++row) {
    if (stage.row_largest[row] < least) {
      error.dropped += stage.row_energy[row];
      continue;
    }
    const float c = stage.values[stage_row(row) + z];
    const float size = c < 0 ? -c : c;
    const float scaled = size * rung.scale;
    const std::int32_t m = magnitude_of(scaled);
    const float one = quantiser_error(scaled, m);
    error.sum += one * one;
    const std::uint32_t place = m == 0 ? 0U : tables.place[8 * row + z] & 511U;
    error.last = place > error.last ? place : error.last;
  }
  return error;
}

// Rungs that are looked at together, one per group of lanes. Group g looks at rung first + g; groups from
// `before_gap` on look `gap` rungs further.
struct RungBatch {
  std::uint32_t first = 0;
  std::uint32_t before_gap = kRungsAtOnce;
  std::uint32_t gap = 0;

  WEIR_HOST_DEVICE std::uint32_t rung(unsigned group) const { return first + group + (group < before_gap ? 0U : gap); }
};

// Calculates the costs of a batch's rungs that lie before `end`, counted from the first rung asked for. Returns
// whether finer rungs are of use.
template <class Warp>
WEIR_HOST_DEVICE bool cost_rungs(const Warp& warp, const CostTables& tables, const BlockStage& stage,
                                 const BlockFigures& figures, double finest, const RungBatch& batch, std::uint32_t end,
                                 RungCost* costs) {
  typename Warp::template Own<GroupRung> rung;
  typename Warp::template Own<float> squares;
  typename Warp::template Own<double> dropped, total;
  typename Warp::template Own<std::uint32_t> last, symbols, raw, nonzero, useful;
  const auto larger = [](std::uint32_t a, std::uint32_t b) { return b > a ? b : a; };
  const auto sum = [](std::uint32_t a, std::uint32_t b) { return a + b; };
  warp.each([&](unsigned lane) {
    const std::uint32_t own = batch.rung(lane / kGroup);
    GroupRung& r = rung(lane);
    const std::int32_t step = rung_step(figures.first_step, static_cast<std::int32_t>(figures.first_rung + own));
    if (own >= end || step < kLeastStep || step > kMostStep) return;
    r.step = step_size(step);
    if (static_cast<double>(r.step) < finest) return;
    r.counted = true;
    r.coded = !(static_cast<double>(figures.largest) / static_cast<double>(r.step) > kMostMagnitude);
    if (!r.coded) return;
    r.scale = 1.0F / r.step;
    const ColumnError error = quantise_column(tables, stage, lane % kGroup, r);
    squares(lane) = error.sum;
    dropped(lane) = error.dropped;
    last(lane) = error.last;
  });
  warp.add_in_order(squares, total);
  warp.of_groups(last, larger);
  warp.each([&](unsigned lane) {
    if (!rung(lane).coded || last(lane) == 0) return;
    const unsigned limit = kEndUnit * (last(lane) / kEndUnit + 1);
    SymbolSums sums = add_column(tables, stage.values, lane % kGroup, rung(lane).scale, limit);
    if (lane % kGroup == 0) {
      add_first_places(
          tables, [&](unsigned index) { return magnitude_at(stage.values[stage_of(index)], rung(lane).scale); },
          [](std::uint32_t known) { return (known >> 12U) * kPackedLevels * kPackedSymbols; }, sums);
    }
    symbols(lane) = sums.symbols;
    raw(lane) = sums.raw;
    nonzero(lane) = sums.nonzero;
  });
  warp.of_groups(symbols, sum);
  warp.of_groups(raw, sum);
  warp.of_groups(nonzero, sum);
  warp.each([&](unsigned lane) {
    const GroupRung& r = rung(lane);
    useful(lane) = 0;
    if (lane % kGroup != 0 || !r.counted) return;
    constexpr std::uint32_t kHeadBits = 8;
    constexpr unsigned kEndBits = 5;
    constexpr unsigned kLeastMeanBits = 6;
    RungCost cost;
    cost.bits = kNotCodedBits;
    if (r.coded) {
      const double step = static_cast<double>(r.step);
      cost.squared_error = dropped(lane) + total(lane) * step * step;
      cost.bits = kHeadBits;
      if (last(lane) != 0) {
        const unsigned of_end = last(lane) / kEndUnit + 1;
        cost.bits += coded_stream_bits(symbols(lane), raw(lane), nonzero(lane), of_end, kEndBits, kLeastMeanBits);
      }
    }
    costs[batch.rung(lane / kGroup)] = cost;
    // Finer rungs are of no use beyond this: a search ends where raw values (2049 bytes) are shorter, and the bits of
    // finer rungs never fall back by 2048.
    constexpr std::uint32_t kMostUseful = 8 * 2049 + 2048;
    useful(lane) = cost.bits <= kMostUseful ? 1U : 0U;
  });
  return warp.of_all(useful, larger) != 0;
}

}  // namespace encode_detail

/// Calculates the figures of a block of the call and the costs of its rungs.
template <class Warp>
WEIR_HOST_DEVICE void survey_block(const Warp& warp, const SurveyCall& call, const CostTables& tables,
                                   std::uint32_t block, encode_detail::BlockStage& stage) {
  using namespace encode_detail;
  gather_block(warp, call.box, block, stage.values);
  const ValueRange8 range = range_of_block(warp, stage.values);
  BlockFigures figures;
  figures.mean = range.mean;
  figures.lattice = may_lie_on_lattice(warp, range, stage.values) ? 1 : 0;
  figures.transformed = range.transformed ? 1 : 0;
  const std::uint32_t most = call.ask.most();
  RungCost* costs = call.costs + std::size_t{most} * block;
  warp.each([&](unsigned lane) {
    if (lane < most) costs[lane] = {};
  });
  if (range.transformed && figures.lattice == 0) {
    transform_stage(warp, range.mean, stage.values);
    const CoefficientSizes sizes = measure_rows(warp, stage);
    figures.largest = sizes.largest;
    figures.energy = sizes.energy;
    if (sizes.energy > 0 && sizes.largest > 0) {
      figures.first_step = static_cast<std::int16_t>(first_rung_step(static_cast<double>(sizes.largest)));
      figures.first_rung = static_cast<std::uint8_t>(call.ask.first(figures.first_step));
      figures.rungs = static_cast<std::uint8_t>(most);
      const float below = range.low < 0 ? -range.low : range.low;
      const float above = range.high < 0 ? -range.high : range.high;
      const double finest = static_cast<double>(below > above ? below : above) * 0x1p-24;
      const auto look_at = [&](const RungBatch& batch) {
        return cost_rungs(warp, tables, stage, figures, finest, batch, most, costs);
      };
      if (!call.ask.searches() || !call.box.covers(block)) {
        std::uint32_t rung = 0;
        while (rung < most && look_at({rung})) rung += kRungsAtOnce;
      } else {
        // Nearly every search ends among the first four. The other rungs are the `first` coarser ones and the finer
        // ones.
        const std::uint32_t start = call.ask.start(figures.first_step) - figures.first_rung;
        const std::uint32_t coarser = start < 2 ? 0U : start - 2;
        const std::uint32_t first = coarser < most - kRungsAtOnce ? coarser : most - kRungsAtOnce;
        look_at({first});
        const auto known = [&](std::uint32_t rung) { return known_rung(costs[rung]); };
        if (next_rung(call.ask.keys, figures.energy, start, most, known) != kNoRung) look_at({0, first, kRungsAtOnce});
      }
    }
  }
  warp.each([&](unsigned lane) {
    if (lane == 0) call.figures[block] = figures;
  });
}

}  // namespace weir
