#include "ingest/plan/block_plan.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/plan/block_axis.h"

namespace weir {
namespace {

using Axes = std::array<BlockAxis, 3>;

std::uint64_t largest_bytes(const Axes& axes) {
  return static_cast<std::uint64_t>(axes[0].longest() * axes[1].longest() * axes[2].longest()) * sizeof(float);
}

/// Grows axis `a` to `size` leaves if that fits the budget.
bool grow(Axes& axes, std::size_t a, std::int64_t size, std::uint64_t budget) {
  const std::int64_t before = axes[a].size;
  axes[a].size = std::clamp(size, before, axes[a].count);
  if (largest_bytes(axes) <= budget) return true;
  axes[a].size = before;
  return false;
}

/// Grows axis `a` to a step (a lower node's width), or to the largest divisor of a step that fits. Returns whether the
/// block has a whole step, or the whole axis.
bool grow_to_step(Axes& axes, std::size_t a, std::uint64_t budget) {
  const std::int64_t units = axes[a].step() / axes[a].unit;
  for (std::int64_t n = units; n > 1; --n) {
    if (units % n == 0 && grow(axes, a, n * axes[a].unit, budget)) return n == units;
  }
  return units == 1 || axes[a].whole();
}

/// Grows axis `a` by whole steps as far as the budget allows. Returns true if it now has the whole axis.
bool grow_by_steps(Axes& axes, std::size_t a, std::uint64_t budget) {
  if (grow(axes, a, axes[a].count, budget)) return true;
  const std::int64_t step = axes[a].step();
  std::int64_t fits = axes[a].size / step;
  std::int64_t too_many = ceil_div(axes[a].count, step);
  while (fits + 1 < too_many) {
    const std::int64_t middle = std::midpoint(fits, too_many);
    (grow(axes, a, middle * step, budget) ? fits : too_many) = middle;
  }
  return false;
}

/// Grows blocks of contiguous rows: first long rows in x for the disk, then a lower node's width in y and in z for
/// the output, then more of both.
void grow_rows(Axes& axes, std::uint64_t budget, BlockShape shape) {
  const std::uint64_t ample = std::clamp(kAmpleBlockBytes, largest_bytes(axes), budget);
  const std::size_t first = shape == BlockShape::wide ? 1 : 2;
  const bool full_rows = grow_by_steps(axes, 0, budget);
  if (!full_rows) {
    grow_to_step(axes, 0, budget);
  } else if (grow_to_step(axes, first, budget) && grow_to_step(axes, 3 - first, budget)) {
    if (grow_by_steps(axes, 1, ample)) grow_by_steps(axes, 2, ample);
  }
}

double amplification(const Axes& axes) {
  constexpr std::int64_t kAll = std::numeric_limits<std::int64_t>::max();
  return axes[0].amplification(kAll) * axes[1].amplification(kAll) * axes[2].amplification(kAll);
}

/// Chooses the cut that decodes the fewest chunks twice. Of several such cuts it takes the one with the longest rows.
void cut_for_chunks(Axes& axes, std::uint64_t budget) {
  const std::array<std::vector<AxisCut>, 3> cuts{useful_cuts(axes[0]), useful_cuts(axes[1]), useful_cuts(axes[2])};
  const auto most_voxels = static_cast<std::int64_t>(budget / sizeof(float));
  double least = std::numeric_limits<double>::infinity();
  for (auto x = cuts[0].rbegin(); x != cuts[0].rend(); ++x) {
    for (auto y = cuts[1].rbegin(); y != cuts[1].rend(); ++y) {
      // Of the cuts in z that fit, the longest has the smallest amplification.
      const std::int64_t fits = most_voxels / (x->longest * y->longest);
      const auto beyond = std::ranges::upper_bound(cuts[2], fits, {}, &AxisCut::longest);
      if (beyond == cuts[2].begin()) continue;
      const AxisCut& z = *std::prev(beyond);
      const double decoded = x->amplification * y->amplification * z.amplification;
      if (decoded >= least) continue;
      least = decoded;
      axes[0].size = x->size;
      axes[1].size = y->size;
      axes[2].size = z.size;
    }
  }
}

}  // namespace

Box BlockPlan::leaf_box(std::int64_t i) const {
  const Index3 block = index_at(i, count);
  const auto from = [](std::int64_t b, std::int64_t size, std::int64_t before) { return b * size - before; };
  const Index3 lo{from(block.x, leaves.x, lead.x), from(block.y, leaves.y, lead.y), from(block.z, leaves.z, lead.z)};
  return intersect({lo, lo + leaves}, {{0, 0, 0}, lattice.count});
}

Box BlockPlan::voxel_box(const Box& leaf_box) const { return lattice.voxels(leaf_box); }

BlockPlan plan_blocks(const Box& domain, const AccessShape& access, std::uint64_t block_bytes, BlockShape shape) {
  Axes axes{BlockAxis(domain.lo.x, domain.hi.x, access.chunk.x, access.chunk_origin.x),
            BlockAxis(domain.lo.y, domain.hi.y, access.chunk.y, access.chunk_origin.y),
            BlockAxis(domain.lo.z, domain.hi.z, access.chunk.z, access.chunk_origin.z)};
  const bool whole_chunks = largest_bytes(axes) <= block_bytes;
  if (!whole_chunks) {
    for (BlockAxis& axis : axes) axis.size = 1;
    const std::uint64_t leaf_bytes = largest_bytes(axes);
    if (leaf_bytes > block_bytes) {
      throw Error(ErrorKind::usage,
                  compose(option("memory"), " leaves ", block_bytes,
                          " bytes for a block of the volume, and one leaf needs ", leaf_bytes, "; raise it"));
    }
  }
  if (whole_chunks) grow_rows(axes, block_bytes, shape);
  if (!whole_chunks || amplification(axes) > 1) cut_for_chunks(axes, block_bytes);

  BlockPlan plan;
  plan.lattice = make_lattice(domain, kLeafDim);
  plan.leaves = {axes[0].size, axes[1].size, axes[2].size};
  plan.lead = {axes[0].lead(), axes[1].lead(), axes[2].lead()};
  plan.count = {axes[0].blocks(), axes[1].blocks(), axes[2].blocks()};
  plan.block_bytes = largest_bytes(axes);
  plan.run_voxels = axes[0].longest();
  if (axes[0].whole()) plan.run_voxels *= axes[1].longest();
  if (axes[0].whole() && axes[1].whole()) plan.run_voxels *= axes[2].longest();
  plan.amplification = amplification(axes);
  return plan;
}

std::uint64_t bytes_for_whole_chunks(const Box& domain, const AccessShape& access) {
  constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;
  std::uint64_t too_few = 0;
  std::uint64_t enough = float32_bytes(domain) / kMiB + 1;
  while (too_few + 1 < enough) {
    const std::uint64_t middle = std::midpoint(too_few, enough);
    (plan_blocks(domain, access, middle * kMiB).amplification > 1 ? too_few : enough) = middle;
  }
  return enough * kMiB;
}

}  // namespace weir
