#include "compressor/packed/ladder_builder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "format/packed/block_decode.h"

namespace weir {
namespace {

constexpr double kMeanError = 0.5 + 1.0 / 16;  // quanta that a decoded mean of kMostBoundedMeanBits is off by

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
  if (bits == 0 || !source.values_as_stored()) return std::nullopt;
  return Lattice{least_of_type(source.type), 1.0F, bits};
}

PackedLadder LadderBuilder::uniform() {
  PackedLadder ladder;
  ladder.exact_bytes = static_cast<std::uint16_t>(kOneValueStreamBytes);
  return ladder;
}

PackedLadder LadderBuilder::build_non_finite(LeafValues& block, const LeafRow& row, NearRungs near) {
  PackedLadder raw;
  raw.exact_bytes = kRawStreamBytes;
  if (aim_.keeps_non_finite) return have_same_bits(block) ? uniform() : raw;
  if (row.finite == 0) return uniform();  // all values become the background
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
  // A budget seldom buys exact blocks. So floats on no lattice are tried in their order only if the block may be kept
  // exactly, or if most values are zero: whole numbers in the floats' order then take fewer bytes than rungs that
  // round.
  const bool may_be_exact = aim_.lossless || (near == NearRungs::yes && !aim_.window);
  set_exact(block, may_be_exact ? FloatOrder::used : FloatOrder::unused, ladder);
  if (aim_.lossless) return ladder;
  bool more = true;
  if (transform_.set(block)) {
    const double energy = filled == Filled::no ? transform_.energy() : row.sse;
    const bool nearly = near == NearRungs::yes && energy > 0;
    if (nearly) rounded_.set(block);
    const auto cost_of = [&](std::size_t rung) { return transform_.cost(ladder.step(rung)); };
    const auto near_cost_of = [&](std::size_t rung) {
      return rounded_.cost(ladder.near_exponent - static_cast<std::int32_t>(rung));
    };
    more = add_rungs(row, TransformRungs(row, energy, transform_.largest(), cost_of, ladder),
                     NearRungBuilder(nearly ? energy : 0, rounded_.exponent(), near_cost_of, ladder), ladder);
  }
  const bool on_no_lattice = ladder.exact_bytes == kRawStreamBytes;
  if (near == NearRungs::yes && !may_be_exact && on_no_lattice && (more || is_sparse(row))) {
    set_exact(block, FloatOrder::used, ladder);
  }
  return ladder;
}

void LadderBuilder::set_exact(const LeafValues& block, FloatOrder order, PackedLadder& ladder) {
  ladder.exact_bytes = static_cast<std::uint16_t>(exact_.write(block, aim_.lattice, stream_, order));
  ladder.exact = is_ordered(stream_) ? ExactKind::ordered : ExactKind::values;
}

std::optional<PackedLadder> LadderBuilder::build_from(const SurveyedBlock& found, const LeafRow& row,
                                                      NearRungs near) const {
  const BlockFigures& figures = found.figures;
  if (figures.lattice != 0) return std::nullopt;
  const bool nearly = near == NearRungs::yes;
  PackedLadder ladder;
  ladder.exact_bytes = static_cast<std::uint16_t>(kRawStreamBytes);
  bool enough = true;
  const auto set_ordered = [&] {
    enough = enough && figures.ordered_bytes != 0;
    ladder.exact_bytes = figures.ordered_bytes;
    ladder.exact = figures.ordered_bytes < kRawStreamBytes ? ExactKind::ordered : ExactKind::values;
  };
  const auto cost_of = [&](std::size_t rung) {
    const std::size_t at = rung - figures.first_rung;
    const bool known = rung >= figures.first_rung && at < figures.rungs && found.costs[at].bits != 0;
    enough = enough && known;
    return known ? TransformBlock::Cost{found.costs[at].bits, found.costs[at].squared_error}
                 : TransformBlock::Cost{kNotCodedBits, 0};
  };
  const auto near_cost_of = [&](std::size_t rung) -> std::optional<RoundedBlock::Cost> {
    const std::size_t at = rung - figures.first_near;
    const bool known = rung >= figures.first_near && at < figures.near && found.near[at].bytes != 0;
    enough = enough && known;
    if (!known || found.near[at].bytes == kNoNearBytes) return std::nullopt;
    return RoundedBlock::Cost{found.near[at].bytes, found.near[at].squared_error};
  };
  // The same condition as in build().
  const bool may_be_exact = nearly && !aim_.window;
  if (may_be_exact) set_ordered();
  bool more = true;
  if (figures.transformed != 0) {
    const std::int32_t exponent = rounded_exponent(std::max(std::fabs(row.min), std::fabs(row.max)));
    more = add_rungs(row, TransformRungs(row, figures.energy, static_cast<double>(figures.largest), cost_of, ladder),
                     NearRungBuilder(nearly ? figures.energy : 0, exponent, near_cost_of, ladder), ladder);
  }
  if (nearly && !may_be_exact && (more || is_sparse(row))) set_ordered();
  return enough ? std::optional(ladder) : std::nullopt;
}

template <class CostOf, class NearCostOf>
bool LadderBuilder::add_rungs(const LeafRow& row, TransformRungs<CostOf> rungs, NearRungBuilder<NearCostOf> near,
                              PackedLadder& ladder) const {
  if (aim_.window) {
    for (std::size_t rung = 0; rung < std::min(rungs.end(), PackedLadder::kMeanRungs); ++rung) rungs.build(rung);
    const auto at = [&](std::size_t rung) { return rungs.point(rung); };
    const auto near_at = [&](std::size_t rung) { return near.point(rung); };
    return ranges_within(*aim_.window, row.sse,
                         RungSearch{start_rung(*aim_.window, ladder), PackedLadder::kMeanRungs, rungs.end(), at},
                         RungSearch{start_near_rung(*aim_.window, ladder), 0, near.end(), near_at})
        .more;
  }
  // Bits hardly ever fall from a rung to the next, and never by so many.
  constexpr std::uint32_t kNoMore = 2048;
  for (std::size_t rung = 0; rung < rungs.end(); ++rung) {
    if (rungs.build(rung) > 8U * ladder.exact_bytes + kNoMore) break;
  }
  for (std::size_t rung = 0; rung < near.end(); ++rung) near.point(rung);
  return true;
}

// The coarsest step at which every value is within `max_error`.
std::optional<std::int32_t> LadderBuilder::bounded_step(const LeafValues& block, double max_error) {
  const double mean = static_cast<double>(transform_.mean());
  double deviation = 0;
  for (const float v : block) deviation = std::max(deviation, std::fabs(static_cast<double>(v) - mean));
  const double rounding = (deviation + std::fabs(mean)) * 0x1p-20;
  const double allowed = max_error - rounding;
  if (deviation < allowed) {
    const std::int32_t step = coarsest_step_within(std::sqrt(double{kLeafVoxels}) / kMeanError * (allowed - deviation));
    // Where coefficients would count at that step, the trials below find as much.
    if (transform_.cost(step).bits <= kMeanAloneBits) return step;
  }
  LeafValues decoded;
  constexpr int kTrials = 16;
  std::int32_t step = coarsest_step_within(8 * max_error);
  for (int trial = 0; trial < kTrials && step <= kMostStep; ++trial, ++step) {
    const TransformBlock::Cost cost = transform_.cost(step);
    // No largest error is below the root of the mean square.
    if (cost.squared_error > double{kLeafVoxels} * max_error * max_error) continue;
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
  const std::uint32_t bounded = exact_.write_bounded(block, max_error, stream_);
  // On a lattice as coarse as the error allows, exact is shorter; on none, floats in their order are not.
  const FloatOrder order = bounded == 0 || aim_.lattice ? FloatOrder::used : FloatOrder::unused;
  const std::uint32_t exact = exact_.write(block, aim_.lattice, stream_, order);
  const bool rounds = bounded > 0 && bounded < exact;
  ladder.exact = rounds ? ExactKind::bounded : ExactKind::values;
  ladder.exact_bytes = static_cast<std::uint16_t>(rounds ? bounded : exact);
  if (!transform_.set(block)) return;
  const auto step = bounded_step(block, max_error);
  if (!step) return;
  // A byte more than is expected, so that no coefficient has to go.
  const std::uint32_t bits = transform_.cost(*step).bits;
  const std::uint32_t enough = bits <= kMeanAloneBits ? bits : bits + 8;
  constexpr std::uint32_t kUsualMeanBits = 12;
  if (stream_bytes(enough, kUsualMeanBits) >= ladder.exact_bytes) return;
  ladder.first_step = static_cast<std::int16_t>(*step);
  ladder.count = 1;
  ladder.rungs[0] = {static_cast<std::uint16_t>(enough), ErrorShare(1)};
}

}  // namespace weir
