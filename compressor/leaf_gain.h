// What keeping a leaf is worth: the order in which leaves are bought.
#pragma once

#include <cstdint>
#include <vector>

#include "compressor/fill.h"
#include "compressor/region_rows.h"

namespace weir {

/// sse: squared error saved (rate-distortion). The others are the paper's distances from a brick's
/// value range [lo, hi] to the background B: closest min(|lo - B|, |hi - B|), farthest the max,
/// median |(lo + hi) / 2 - B| (Zellmann et al., EGPGV 2025).
enum class Metric { sse, farthest, closest, median };

struct LeafGain {
  double gain = 0;             ///< squared error saved, or the brick's distance; 0 where `exact`
  std::uint32_t brick = 0;     ///< rank of its brick in the region; of itself for sse
  std::uint16_t position = 0;  ///< in the lower node's masks: x<<8 | y<<4 | z
  bool exact = false;          ///< its tile reads the same bits: never worth a leaf
  bool required = false;       ///< always a leaf
};

/// Decides gains; the same for every thread, plan and memory ceiling.
struct GainRule {
  Metric metric = Metric::sse;
  std::int64_t brick_leaves = 1;  ///< leaves along a brick of the paper's metrics: 1, 2 or 4
  Fill fill;

  /// Gains of a region's leaves in leaf-index order. The two corner leaves of the domain, and those that
  /// hold non-finite values to keep, are required.
  void gains(const TreeRegions& tree, const RegionRows& rows, std::vector<LeafGain>& out) const;

 private:
  // The paper's metrics: gain of each leaf from its brick's range.
  void rank_bricks(const RegionRows& rows, std::vector<LeafGain>& leaves) const;
};

}  // namespace weir
