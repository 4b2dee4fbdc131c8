#include "ingest/block_plan.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "format/error.h"
#include "format/text.h"

namespace weir {
namespace {

constexpr std::int64_t ceil_div(std::int64_t a, std::int64_t b) { return -floor_div(-a, b); }

/// One axis of a plan. Lengths in leaves, except where they say voxels.
struct Axis {
  std::int64_t lo = 0;          ///< domain, voxels
  std::int64_t hi = 0;          ///< domain, voxels
  std::int64_t first = 0;       ///< global coordinate of the first leaf
  std::int64_t count = 0;       ///< leaves
  std::int64_t chunk = 0;       ///< voxels, zero where not chunked
  std::int64_t chunk_edge = 0;  ///< index of any chunk's edge, voxels
  std::int64_t unit = 1;        ///< smallest block that ends with a chunk; 1 where there is none
  std::int64_t size = 1;        ///< the block's length as chosen so far

  /// Smallest multiple of the unit that holds a lower node's width.
  std::int64_t step() const { return unit * ceil_div(kLowerLeaves, unit); }
  bool whole() const { return size >= count; }
  /// Leaves of the first block before the domain's first leaf. Blocks lie on multiples of their size
  /// from the global origin, or from a chunk's edge.
  std::int64_t lead() const {
    if (whole()) return 0;
    const std::int64_t anchor = unit > 1 ? floor_div(chunk_edge, kLeafDim) : 0;
    return first - anchor - floor_div(first - anchor, size) * size;
  }
  std::int64_t blocks() const { return ceil_div(count + lead(), size); }
  /// Lattice positions of block k.
  std::int64_t begin(std::int64_t k) const { return std::max<std::int64_t>(k * size - lead(), 0); }
  std::int64_t end(std::int64_t k) const { return std::min((k + 1) * size - lead(), count); }
  std::int64_t voxels(std::int64_t k) const {
    return std::min((first + end(k)) * kLeafDim, hi) - std::max((first + begin(k)) * kLeafDim, lo);
  }
  /// Voxels of the longest block: one in the middle where there is one.
  std::int64_t longest() const {
    const std::int64_t n = blocks();
    return std::max({voxels(0), voxels(std::min<std::int64_t>(1, n - 1)), voxels(n - 1)});
  }
  /// Chunks decoded, all blocks together, over chunks there are.
  double amplification() const {
    const auto chunks = [&](std::int64_t from, std::int64_t to) {
      return floor_div(to - 1 - chunk_edge, chunk) - floor_div(from - chunk_edge, chunk) + 1;
    };
    std::int64_t decoded = 0;
    for (std::int64_t k = 0; k < blocks(); ++k) {
      const std::int64_t from = std::max((first + begin(k)) * kLeafDim, lo);
      decoded += chunks(from, from + voxels(k));
    }
    return static_cast<double>(decoded) / static_cast<double>(chunks(lo, hi));
  }
};

using Axes = std::array<Axis, 3>;

Axis make_axis(std::int64_t lo, std::int64_t hi, std::int64_t chunk, std::int64_t chunk_edge) {
  Axis axis;
  axis.lo = lo;
  axis.hi = hi;
  axis.first = floor_div(lo, kLeafDim);
  axis.count = floor_div(hi - 1, kLeafDim) + 1 - axis.first;
  axis.chunk = chunk;
  axis.chunk_edge = chunk_edge;
  // Where chunk edges are off the leaf lattice, no block of leaves ends with a chunk.
  if (chunk > 0 && chunk_edge % kLeafDim == 0) {
    axis.unit = std::min(std::lcm(chunk, kLeafDim) / kLeafDim, axis.count);
  }
  return axis;
}

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

/// Grows axis `a` to a step (a lower node's width) or to the largest divisor of one that fits.
bool grow_to_step(Axes& axes, std::size_t a, std::uint64_t budget) {
  const std::int64_t units = axes[a].step() / axes[a].unit;
  for (std::int64_t n = units; n > 1; --n) {
    if (units % n == 0 && grow(axes, a, n * axes[a].unit, budget)) return n == units;
  }
  return units == 1 || axes[a].whole();
}

/// Grows axis `a` by whole steps as far as the budget allows; true where that is all of it.
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

}  // namespace

Box BlockPlan::leaf_box(std::int64_t i) const {
  const Index3 block = index_at(i, count);
  const auto from = [](std::int64_t b, std::int64_t size, std::int64_t before) { return b * size - before; };
  const Index3 lo{from(block.x, leaves.x, lead.x), from(block.y, leaves.y, lead.y), from(block.z, leaves.z, lead.z)};
  return intersect({lo, lo + leaves}, {{0, 0, 0}, lattice.count});
}

Box BlockPlan::voxel_box(const Box& leaf_box) const {
  return intersect({(lattice.first + leaf_box.lo) * kLeafDim, (lattice.first + leaf_box.hi) * kLeafDim},
                   lattice.domain);
}

BlockPlan plan_blocks(const Box& domain, const AccessShape& access, std::uint64_t block_bytes, BlockShape shape) {
  Axes axes{make_axis(domain.lo.x, domain.hi.x, access.chunk.x, access.chunk_origin.x),
            make_axis(domain.lo.y, domain.hi.y, access.chunk.y, access.chunk_origin.y),
            make_axis(domain.lo.z, domain.hi.z, access.chunk.z, access.chunk_origin.z)};
  const std::uint64_t leaf_bytes = largest_bytes(axes);
  if (leaf_bytes > block_bytes) {
    throw Error(ErrorKind::usage,
                cat("--memory leaves ", block_bytes, " bytes for a block of the volume, and one leaf needs ",
                    leaf_bytes, "; raise it"));
  }

  // Whole chunks, where one of them fits at all.
  for (Axis& axis : axes) axis.size = axis.unit;
  if (largest_bytes(axes) > block_bytes) {
    for (Axis& axis : axes) axis.size = axis.unit = 1;
  }
  // Long rows for the disk, then a lower node's width in y and in z for the output, then more of both.
  const std::uint64_t ample = std::clamp(kAmpleBlockBytes, largest_bytes(axes), block_bytes);
  const std::size_t first = shape == BlockShape::wide ? 1 : 2;
  const bool full_rows = grow_by_steps(axes, 0, block_bytes);
  if (!full_rows) {
    grow_to_step(axes, 0, block_bytes);
  } else if (grow_to_step(axes, first, block_bytes) && grow_to_step(axes, 3 - first, block_bytes)) {
    if (grow_by_steps(axes, 1, ample)) grow_by_steps(axes, 2, ample);
  }

  BlockPlan plan;
  plan.lattice = make_lattice(domain, kLeafDim);
  plan.leaves = {axes[0].size, axes[1].size, axes[2].size};
  plan.lead = {axes[0].lead(), axes[1].lead(), axes[2].lead()};
  plan.count = {axes[0].blocks(), axes[1].blocks(), axes[2].blocks()};
  plan.block_bytes = largest_bytes(axes);
  plan.run_voxels = axes[0].longest();
  if (axes[0].whole()) plan.run_voxels *= axes[1].longest();
  if (axes[0].whole() && axes[1].whole()) plan.run_voxels *= axes[2].longest();
  if (access.chunk != Index3{}) {
    plan.amplification = axes[0].amplification() * axes[1].amplification() * axes[2].amplification();
  }
  return plan;
}

}  // namespace weir
