#include "compressor/packed/ladder_builder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "compressor/packed/exact_block.h"
#include "format/packed/block_decode.h"

namespace weir {
namespace {

constexpr double kDeadZone = 0.6;              // steps below which a coefficient becomes 0
constexpr std::int32_t kMeanSteps = 4;         // of a ladder before the first coefficient counts
constexpr double kMeanError = 0.5 + 1.0 / 16;  // quanta that a decoded mean of kMostBoundedMeanBits is off by
constexpr std::uint32_t kUniformBytes = 5;     // kind and value

// The coarsest step of at most `size`.
std::int32_t coarsest_of_at_most(double size) {
  std::int32_t step = std::clamp(-2 * (std::ilogb(size) + 1), kLeastStep, kMostStep);
  while (step<kMostStep&& static_cast<double>(step_size(step))> size) ++step;
  return step;
}

bool have_same_bits(const LeafValues& block) {
  const auto first = std::bit_cast<std::uint32_t>(block[0]);
  return std::all_of(block.begin(), block.end(), [&](float v) { return std::bit_cast<std::uint32_t>(v) == first; });
}

double largest_difference(const LeafValues& a, const LeafValues& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::fabs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
  }
  return largest;
}

BlockConstants unclamped(std::int32_t coarsest) {
  BlockConstants constants;
  constants.minimum = std::numeric_limits<float>::lowest();
  constants.maximum = std::numeric_limits<float>::max();
  constants.coarsest = coarsest;
  constants.below_one = kBelowOne;
  constants.below_more = kBelowMore;
  constants.tables = built_in_tables();
  return constants;
}

std::uint32_t bits_of_type(ScalarType type) {
  switch (type) {
    case ScalarType::uint8:
    case ScalarType::int8:
      return 8;
    case ScalarType::uint16:
    case ScalarType::int16:
      return 16;
    default:
      return 0;
  }
}

float least_of_type(ScalarType type) {
  return type == ScalarType::int8 ? -128.0F : type == ScalarType::int16 ? -32768.0F : 0.0F;
}

}  // namespace

std::optional<Lattice> lattice_of(const SourceInfo& source) {
  const std::uint32_t bits = bits_of_type(source.type);
  if (bits == 0 || source.mapping.scales()) return std::nullopt;
  return Lattice{least_of_type(source.type), 1.0F, bits};
}

PackedLadder LadderBuilder::uniform() {
  PackedLadder ladder;
  ladder.exact_bytes = kUniformBytes;
  return ladder;
}

PackedLadder LadderBuilder::build_non_finite(LeafValues& block, const LeafRow& row, NearRungs near) {
  PackedLadder raw;
  raw.exact_bytes = kRawStreamBytes;
  if (aim_.keeps_non_finite) return have_same_bits(block) ? uniform() : raw;
  if (row.finite == 0) return uniform();  // all become the background
  if (!aim_.background) return raw;
  for (float& v : block) {
    if (!std::isfinite(v)) v = *aim_.background;
  }
  return have_same_bits(block) ? uniform() : build(block, row, near, Filled::yes);
}

PackedLadder LadderBuilder::build(const LeafValues& block, const LeafRow& row, NearRungs near) {
  return build(block, row, near, Filled::no);
}

PackedLadder LadderBuilder::build(const LeafValues& block, const LeafRow& row, NearRungs near, Filled filled) {
  PackedLadder ladder;
  if (aim_.max_error) {
    build_bounded(block, *aim_.max_error, ladder);
    return ladder;
  }
  set_exact(block, near, ladder);
  if (aim_.lossless || !transform_.set(block)) return ladder;
  const double energy = filled == Filled::no ? transform_.energy() : row.sse;
  add_rungs(row, energy, ladder);
  if (near == NearRungs::yes) add_near_rungs(block, energy, ladder);
  return ladder;
}

void LadderBuilder::add_near(const LeafValues& block, PackedLadder& ladder) {
  set_exact(block, NearRungs::yes, ladder);
  if (transform_.set(block)) add_near_rungs(block, transform_.energy(), ladder);
}

void LadderBuilder::set_exact(const LeafValues& block, NearRungs near, PackedLadder& ladder) {
  // What a budget of bytes can buy is seldom exact: floats on no lattice are then not looked at that closely.
  const FloatOrder order = aim_.lossless || near == NearRungs::yes ? FloatOrder::used : FloatOrder::unused;
  ladder.exact_bytes = static_cast<std::uint16_t>(write_exact(block, aim_.lattice, stream_, order));
  ladder.exact = is_ordered(stream_) ? ExactKind::ordered : ExactKind::values;
}

void LadderBuilder::add_rungs(const LeafRow& row, double energy, PackedLadder& ladder) {
  const double largest = transform_.largest();
  if (!(energy > 0 && largest > 0)) return;
  const std::int32_t first = coarsest_of_at_most(largest / kDeadZone);
  ladder.first_step = static_cast<std::int16_t>(first - kMeanSteps);
  // Finer than float32 resolves the values themselves: nothing is gained.
  const double finest = static_cast<double>(std::max(std::fabs(row.min), std::fabs(row.max))) * 0x1p-24;
  for (std::size_t rung = 0; rung < PackedLadder::kMostRungs; ++rung) {
    const std::int32_t step = ladder.step(rung);
    if (step < kLeastStep || step > kMostStep || static_cast<double>(step_size(step)) < finest) break;
    const TransformBlock::Cost cost = rung < 2 ? TransformBlock::Cost{8, energy} : transform_.cost(step);
    if (cost.bits + 8 >= 8U * ladder.exact_bytes) break;
    const double share = std::min(1.0, cost.squared_error / energy);
    ladder.rungs[rung] = {static_cast<std::uint16_t>(cost.bits), ErrorShare(share)};
    ladder.count = static_cast<std::uint8_t>(rung + 1);
  }
}

void LadderBuilder::add_near_rungs(const LeafValues& block, double energy, PackedLadder& ladder) {
  ladder.near_count = 0;
  if (!(energy > 0)) return;
  rounded_.set(block);
  const int finest = rounded_.exponent() - RoundedBlock::kMostBits;
  const int coarsest = finest + static_cast<int>(PackedLadder::kMostNear) - 1;
  if (coarsest > std::numeric_limits<std::int8_t>::max() || finest < std::numeric_limits<std::int8_t>::min()) return;
  ladder.near_exponent = static_cast<std::int8_t>(coarsest);
  for (int exponent = coarsest; exponent >= finest; --exponent) {
    const auto cost = rounded_.cost(exponent);
    if (!cost && ladder.near_count == 0) {  // of one value, far from zero
      --ladder.near_exponent;
      continue;
    }
    if (!cost || cost->bytes >= ladder.exact_bytes) break;
    const double share = std::min(1.0, cost->squared_error / energy);
    ladder.near[ladder.near_count++] = {static_cast<std::uint16_t>(cost->bytes), ErrorShare(share)};
  }
}

// The coarsest step at which every value is within `max_error`.
std::optional<std::int32_t> LadderBuilder::bounded_step(const LeafValues& block, double max_error) {
  const double mean = static_cast<double>(transform_.mean());
  double deviation = 0;
  for (const float v : block) deviation = std::max(deviation, std::fabs(static_cast<double>(v) - mean));
  const double rounding = (deviation + std::fabs(mean)) * 0x1p-20;
  const double allowed = max_error - rounding;
  if (deviation < allowed) {
    const std::int32_t step = coarsest_of_at_most(std::sqrt(512.0) / kMeanError * (allowed - deviation));
    // Where coefficients would count at that step, the trials below find as much.
    if (transform_.cost(step).bits <= 8) return step;
  }
  LeafValues decoded;
  constexpr int kTrials = 16;
  std::int32_t step = coarsest_of_at_most(8 * max_error);
  for (int trial = 0; trial < kTrials && step <= kMostStep; ++trial, ++step) {
    const TransformBlock::Cost cost = transform_.cost(step);
    // No largest error is below the root of the mean square.
    if (cost.squared_error > 512 * max_error * max_error) continue;
    const MeanRange exact{transform_.mean(), transform_.mean()};
    const BlockConstants constants = unclamped(step);
    const std::uint32_t bytes = stream_bytes(cost.bits + 8, mean_bits(exact, step));
    if (bytes > kRawStreamBytes) return std::nullopt;
    const std::span<std::byte> out = std::span(stream_).first(bytes);
    transform_.encode(constants, exact, step, out);
    if (!decode_block(constants, exact, out.data(), bytes, decoded.data())) continue;
    if (largest_difference(block, decoded) + kMeanError * static_cast<double>(mean_quantum(step)) <= allowed)
      return step;
  }
  return std::nullopt;
}

void LadderBuilder::build_bounded(const LeafValues& block, double max_error, PackedLadder& ladder) {
  const std::uint32_t bounded = write_bounded(block, max_error, stream_);
  // On a lattice as coarse as the error allows, exact is shorter.
  const std::uint32_t exact =
      bounded == 0 || aim_.lattice ? write_exact(block, aim_.lattice, stream_) : kRawStreamBytes;
  const bool rounds = bounded > 0 && bounded < exact;
  ladder.exact = rounds ? ExactKind::bounded : ExactKind::values;
  ladder.exact_bytes = static_cast<std::uint16_t>(rounds ? bounded : exact);
  if (!transform_.set(block)) return;
  const auto step = bounded_step(block, max_error);
  if (!step) return;
  // A byte more than is expected, so that no coefficient has to go.
  const std::uint32_t bits = transform_.cost(*step).bits;
  const std::uint32_t enough = bits <= 8 ? bits : bits + 8;
  constexpr std::uint32_t kUsualMeanBits = 12;
  if (stream_bytes(enough, kUsualMeanBits) >= ladder.exact_bytes) return;
  ladder.first_step = static_cast<std::int16_t>(*step);
  ladder.count = 1;
  ladder.rungs[0] = {static_cast<std::uint16_t>(enough), ErrorShare(1)};
}

}  // namespace weir
