// Builders for the rungs of one block's ladder. Each rung is built when it is first asked for. The costs come from the
// block itself, or from a coder's findings about the block.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "compressor/leaf/leaf_row.h"
#include "compressor/packed/packed_ladder.h"
#include "format/packed/block_encode.h"
#include "format/packed/rounded_block.h"

namespace weir {

/// Builds rungs of the transform, with errors as shares of `energy`. CostOf maps a rung to the TransformBlock::Cost at
/// its step.
template <class CostOf>
class TransformRungs {
 public:
  /// Sets the ladder's first step. `largest` is the block's largest coefficient.
  TransformRungs(const LeafRow& row, double energy, double largest, CostOf cost_of, PackedLadder& ladder)
      : energy_(energy), cost_of_(std::move(cost_of)), ladder_(ladder) {
    if (!(energy > 0 && largest > 0)) return;
    ladder.first_step = static_cast<std::int16_t>(first_rung_step(largest));
    // A step finer than float32's resolution of the values gains nothing.
    const double finest = static_cast<double>(std::max(std::fabs(row.min), std::fabs(row.max))) * 0x1p-24;
    const auto is_useful = [&](std::size_t rung) {
      const std::int32_t step = ladder_.step(rung);
      return step >= kLeastStep && step <= kMostStep && static_cast<double>(step_size(step)) >= finest;
    };
    // Steps grow finer from rung to rung. Most blocks can use all rungs.
    if (is_useful(0) && is_useful(PackedLadder::kMostRungs - 1)) end_ = PackedLadder::kMostRungs;
    while (end_ < PackedLadder::kMostRungs && is_useful(end_)) ++end_;
  }

  std::size_t end() const { return end_; }
  /// Sets a rung of the ladder if its stream is shorter than the exact one. Returns the rung's bits, set or not.
  std::uint32_t build(std::size_t rung) {
    const bool mean = rung < PackedLadder::kMeanRungs;
    const TransformBlock::Cost cost = mean ? TransformBlock::Cost{kMeanAloneBits, energy_} : cost_of_(rung);
    if (cost.bits + 8 >= 8U * ladder_.exact_bytes) return cost.bits;
    ladder_.rungs[rung] = {static_cast<std::uint16_t>(cost.bits),
                           ErrorShare(std::min(1.0, cost.squared_error / energy_))};
    ladder_.count = std::max(ladder_.count, static_cast<std::uint8_t>(rung + 1));
    return cost.bits;
  }
  std::optional<RungPoint> point(std::size_t rung) {
    if (!std::exchange(tried_[rung], true)) build(rung);
    return ladder_.point(rung);
  }

 private:
  double energy_;
  CostOf cost_of_;
  PackedLadder& ladder_;
  std::size_t end_ = 0;
  std::array<bool, PackedLadder::kMostRungs> tried_{};
};

/// Builds near rungs. CostOf maps a rung to the RoundedBlock::Cost at its quantum, or nullopt if there is none.
template <class CostOf>
class NearRungBuilder {
 public:
  /// Sets the ladder's coarsest quantum. `exponent` is the exponent of the block's largest |value|. There are no rungs
  /// if `energy` is 0.
  NearRungBuilder(double energy, std::int32_t exponent, CostOf cost_of, PackedLadder& ladder)
      : energy_(energy), cost_of_(std::move(cost_of)), ladder_(ladder) {
    if (!(energy > 0)) return;
    const std::int32_t coarsest = coarsest_near_exponent(exponent);
    const std::int32_t finest = coarsest - (kNearRungs - 1);
    if (coarsest > std::numeric_limits<std::int8_t>::max() || finest < std::numeric_limits<std::int8_t>::min()) return;
    ladder.near_exponent = static_cast<std::int8_t>(coarsest);
    end_ = PackedLadder::kMostNear;
  }

  std::size_t end() const { return end_; }
  /// Sets a rung of the ladder if its stream is shorter than the exact one and its rounded values are not all the same.
  /// Returns the rung's point; nullopt if the rung is not set.
  std::optional<RungPoint> point(std::size_t rung) {
    if (!std::exchange(tried_[rung], true)) build(rung);
    return ladder_.near_point(rung);
  }

 private:
  void build(std::size_t rung) {
    const std::optional<RoundedBlock::Cost> cost = cost_of_(rung);
    if (!cost || cost->bytes >= ladder_.exact_bytes) return;
    ladder_.near[rung] = {static_cast<std::uint16_t>(cost->bytes),
                          ErrorShare(std::min(1.0, cost->squared_error / energy_))};
    ladder_.near_count = std::max(ladder_.near_count, static_cast<std::uint8_t>(rung + 1));
  }

  double energy_;
  CostOf cost_of_;
  PackedLadder& ladder_;
  std::size_t end_ = 0;
  std::array<bool, PackedLadder::kMostNear> tried_{};
};

}  // namespace weir
