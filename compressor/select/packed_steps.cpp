// The steps of a packed block: the ways to keep it that are worth their bytes, out of its ladder.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "compressor/packed/ladder_window.h"
#include "compressor/packed/packed_ladder.h"
#include "compressor/select/leaf_gain.h"

namespace weir {
namespace {

// A way to keep a packed block. Like Corner, it has no initial values, because there is room for many but few are used.
struct PackedPoint {
  std::uint32_t bytes;
  double error;
  KeptLevel level;
};

// Returns the error saved per byte from one way to a longer one.
double key_between(const PackedPoint& from, const PackedPoint& to) {
  return (from.error - to.error) / static_cast<double>(to.bytes - from.bytes);
}

LeafStep packed_step(const PackedPoint& from, const PackedPoint& to) {
  return {from.error - to.error, key_between(from, to), to.bytes - from.bytes, to.level};
}

// The lower convex hull of error over bytes, grown from few bytes to many.
class PackedHull {
 public:
  explicit PackedHull(double error_of_none) { corners_[count_++].point = {0, error_of_none, 0}; }

  void add(const PackedPoint& point) {
    while (count_ > 1 && point.bytes <= last().bytes && point.error <= last().error) --count_;
    if (point.bytes <= last().bytes || point.error >= last().error) return;
    double key = key_between(last(), point);
    while (count_ > 1 && corners_[count_ - 1].key <= key) {
      --count_;
      key = key_between(last(), point);
    }
    corners_[count_++] = {point, key};
  }
  const PackedPoint& last() const { return corners_[count_ - 1].point; }
  void add_steps(LeafGain& leaf, RegionGains& out) const {
    for (std::size_t i = 1; i < count_; ++i) {
      const PackedPoint& from = corners_[i - 1].point;
      const PackedPoint& to = corners_[i].point;
      out.add(leaf, {from.error - to.error, corners_[i].key, to.bytes - from.bytes, to.level});
    }
  }

 private:
  struct Corner {
    PackedPoint point;
    double key;  // from the corner before it
  };
  std::array<Corner, PackedLadder::kMostRungs + PackedLadder::kMostNear + 2> corners_;
  std::size_t count_ = 0;
};

constexpr auto kEndBytes = static_cast<std::uint32_t>(packed::chunk::kEndBytes);

}  // namespace

void GainRule::add_packed_steps(const PackedLadder& ladder, const SharedValues& region, const RegionStreams& streams,
                                const LeafRow& row, std::int64_t voxels, const MinMax* reach, LeafGain& leaf,
                                RegionGains& out) const {
  const Weights weights = weights_of(reach, region.value);
  const double none = leaf.exact ? 0 : weights.tile * row.sse_about(region.value);
  const auto stream = [&](KeptLevel level) {
    const std::uint32_t bytes = streams.bytes(ladder, level);
    return bytes == 0 ? 0 : bytes + kEndBytes;
  };
  const PackedPoint exact{stream(kExactLevel), 0, kExactLevel};
  if (max_error) {
    leaf.required = leaf.required || (weights.tile > 0 && row.max_abs_about(region.value) > *max_error);
    leaf.lossless = true;
    if (!leaf.required) return;
    const bool bounded = ladder.count > 0 && streams.step(ladder, 0) == ladder.step(0) &&
                         mean_bits(region.means, ladder.step(0)) <= kMostBoundedMeanBits;
    const PackedPoint rung{bounded ? stream(1) : 0, 0, 1};
    out.add(leaf, packed_step({0, none, 0}, rung.bytes > 0 && rung.bytes < exact.bytes ? rung : exact));
    return;
  }
  const bool nothing_does = leaf.exact || !(weights.tile > 0);
  leaf.lossless = true;
  if (nothing_does && !leaf.required) return;
  std::array<PackedPoint, PackedLadder::kMostRungs + PackedLadder::kMostNear> ways;
  std::size_t count = 0;
  const auto add = [&](KeptLevel first, std::size_t rung, const RegionStreams::Stream& way) {
    if (way.bytes == 0) return;
    ways[count++] = {way.bytes + kEndBytes, weights.kept * way.error, static_cast<KeptLevel>(first + rung)};
  };
  const auto add_rungs = [&](const RungRange& rungs) {
    for (std::size_t rung = rungs.first; rung < rungs.end; ++rung) {
      add(1, rung, streams.rung(ladder, rung, row, voxels));
    }
  };
  LadderRange range{{PackedLadder::kMeanRungs, ladder.count}, {0, ladder.near_count}};
  if (packed->window) range = range_within(*packed->window, ladder, row);
  add_rungs({0, std::min<std::size_t>(PackedLadder::kMeanRungs, ladder.count)});
  add_rungs(range.rungs);
  for (std::size_t rung = range.near.first; rung < range.near.end; ++rung) {
    add(kFirstNearLevel, rung, RegionStreams::near_rung(ladder, rung, row));
  }
  if (range.near.first < range.near.end) {
    std::sort(ways.begin(), ways.begin() + static_cast<std::ptrdiff_t>(count),
              [](const PackedPoint& a, const PackedPoint& b) {
                return a.bytes != b.bytes ? a.bytes < b.bytes : a.level < b.level;
              });
  }
  PackedHull hull(none);
  for (std::size_t i = 0; i < count; ++i) hull.add(ways[i]);
  hull.add(exact);
  hull.add_steps(leaf, out);
  // Saves nothing that can be measured, but without it not every bit is kept.
  if (hull.last().level != kExactLevel && exact.bytes > hull.last().bytes)
    out.add(leaf, packed_step(hull.last(), exact));
}

}  // namespace weir
