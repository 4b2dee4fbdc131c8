#include "compressor/compare/compare.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "compressor/leaf/exact_sum.h"
#include "compressor/leaf/leaf_difference.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/extent.h"

namespace weir {
namespace {

/// Number of lower nodes to compare before their pages are released: 9 MiB each if all leaves are float32.
constexpr std::int64_t kRegionsAtATime = 4;

/// The tally of one thread. Tallies can be merged in any order.
class DifferenceTally {
 public:
  // `marks_missing` says whether a source voxel may be missing_value().
  void add_leaf(const Block& block, const NvdbGrid& grid, const NodeLattice& leaves, const Index3& leaf,
                bool marks_missing) {
    const Box node = leaves.node_box(leaf);
    const Box inside = leaves.voxels(leaf);
    gather_leaf(block.values, block.voxels, node, inside, 0.0F, source_);
    grid.decode_block(grid.block_at(node.lo), decoded_);
    // Makes voxels outside the domain equal, so that they add no error.
    if (inside != node) decoded_ = inside_only(decoded_, source_, node, inside);
    const LeafDifference difference = difference_of(source_, decoded_);
    squared_error_.add(difference.squared_error);
    nonfinite_ += difference.nonfinite;
    nonfinite_decoded_ += difference.nonfinite_decoded;
    different_ += difference.different;
    nonfinite_different_ += difference.nonfinite_different;
    zeros_lost_ += difference.zeros_lost;
    zeros_ += zeros_inside(node, inside);
    if (marks_missing && difference.nonfinite > 0) count_missing(node, inside);
    // Voxels outside the domain are zeros, which would widen the range.
    widen(inside == node ? difference.range : range_inside(node, inside));
    if (difference.max_abs > 0.0 && difference.max_abs >= max_abs_) {
      offer_maximum(difference.max_abs, first_maximum(node, inside, difference.max_abs));
    }
  }

  void merge(const DifferenceTally& other) {
    squared_error_.add(other.squared_error_);
    nonfinite_ += other.nonfinite_;
    nonfinite_decoded_ += other.nonfinite_decoded_;
    different_ += other.different_;
    nonfinite_different_ += other.nonfinite_different_;
    missing_ += other.missing_;
    missing_different_ += other.missing_different_;
    zeros_ += other.zeros_;
    zeros_lost_ += other.zeros_lost_;
    widen(other.range_);
    if (other.max_abs_ > 0.0) offer_maximum(other.max_abs_, other.max_abs_at_);
  }

  Comparison result(const Box& domain) const {
    Comparison c;
    c.voxels = static_cast<std::uint64_t>(domain.voxels());
    c.nonfinite = nonfinite_;
    c.finite = c.voxels - nonfinite_;
    c.nonfinite_decoded = nonfinite_decoded_;
    c.different = different_;
    c.nonfinite_different = nonfinite_different_;
    c.missing = missing_;
    c.missing_different = missing_different_;
    c.zeros = zeros_;
    c.zeros_lost = zeros_lost_;
    if (c.finite > 0) c.range = range_;
    if (max_abs_ > 0.0) c.max_abs_at = max_abs_at_;
    const MinMax range = c.range.value_or(MinMax{0.0F, 0.0F});
    const std::uint64_t compared = c.finite - c.nonfinite_decoded;
    c.error = make_certificate(squared_error_.value(), max_abs_, different_ == 0, compared, range.min, range.max);
    return c;
  }

 private:
  static std::size_t position(const Index3& offset) {
    return static_cast<std::size_t>(offset.x << 6 | offset.y << 3 | offset.z);
  }

  std::uint64_t zeros_inside(const Box& node, const Box& inside) const {
    if (inside == node) return static_cast<std::uint64_t>(std::count(source_.begin(), source_.end(), 0.0F));
    std::uint64_t zeros = 0;
    for_each_index(inside, [&](const Index3& i) { zeros += source_[position(i - node.lo)] == 0.0F ? 1 : 0; });
    return zeros;
  }

  void count_missing(const Box& node, const Box& inside) {
    for_each_index(inside, [&](const Index3& i) {
      const std::size_t at = position(i - node.lo);
      if (!is_missing(source_[at])) return;
      ++missing_;
      if (!is_missing(decoded_[at])) ++missing_different_;
    });
  }

  MinMax range_inside(const Box& node, const Box& inside) const {
    MinMax range{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
    for_each_index(inside, [&](const Index3& i) {
      const float value = source_[position(i - node.lo)];
      if (value - value != 0.0F) return;
      range.min = std::min(range.min, value);
      range.max = std::max(range.max, value);
    });
    return range;
  }

  Index3 first_maximum(const Box& node, const Box& inside, double max_abs) const {
    Index3 first = inside.hi;
    for_each_index(inside, [&](const Index3& i) {
      const std::size_t at = position(i - node.lo);
      if (first == inside.hi && abs_difference(source_[at], decoded_[at]) == max_abs) first = i;
    });
    return first;
  }

  static bool comes_before(const Index3& a, const Index3& b) {
    if (a.z != b.z) return a.z < b.z;
    if (a.y != b.y) return a.y < b.y;
    return a.x < b.x;
  }

  void offer_maximum(double max_abs, const Index3& at) {
    if (max_abs > max_abs_ || (max_abs == max_abs_ && comes_before(at, max_abs_at_))) {
      max_abs_ = max_abs;
      max_abs_at_ = at;
    }
  }

  void widen(const MinMax& range) {
    range_.min = std::min(range_.min, range.min);
    range_.max = std::max(range_.max, range.max);
  }

  ExactSum squared_error_;
  double max_abs_ = 0;
  Index3 max_abs_at_;
  MinMax range_{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
  std::uint64_t nonfinite_ = 0;
  std::uint64_t nonfinite_decoded_ = 0;
  std::uint64_t different_ = 0;
  std::uint64_t nonfinite_different_ = 0;
  std::uint64_t missing_ = 0;
  std::uint64_t missing_different_ = 0;
  std::uint64_t zeros_ = 0;
  std::uint64_t zeros_lost_ = 0;
  LeafValues source_{};
  LeafValues decoded_{};
};

// Calls visit(leaf) for the leaves of `leaf_box` (lattice positions) and after_some() after every few lower nodes.
template <typename Visit>
void for_each_leaf(const NodeLattice& leaves, const Box& leaf_box, const std::function<void()>& after_some,
                   const Visit& visit) {
  const Box global{leaves.first + leaf_box.lo, leaves.first + leaf_box.hi};
  const NodeLattice regions = make_lattice(global, kLowerLeaves);
  for (std::int64_t first = 0; first < regions.size(); first += kRegionsAtATime) {
    const std::int64_t last = std::min(first + kRegionsAtATime, regions.size());
    tbb::parallel_for(first, last, [&](std::int64_t region) {
      const Box box = regions.voxels(regions.position(region));
      tbb::parallel_for(std::int64_t{0}, box.voxels(),
                        [&](std::int64_t i) { visit(box.lo + index_at(i, box.extent()) - leaves.first); });
    });
    if (after_some) after_some();
  }
}

}  // namespace

Comparison compare_volumes(VolumeSource& source, const NvdbGrid& grid, const std::string& grid_path,
                           const CompareOptions& options) {
  const Box domain = source.info().domain();
  if (grid.index_bbox() != domain) {
    throw Error(ErrorKind::input,
                compose(grid_path, ": holds the voxels ", box_text(grid.index_bbox()), ", ", source.info().path,
                        " holds ", box_text(domain), "; give the source it was converted from, with the same ",
                        option("dims"), " and ", option("roi")));
  }
  const BlockPlan plan = plan_blocks(domain, source.access(), options.block_bytes);
  std::vector<Box> boxes;
  for (std::int64_t i = 0; i < plan.size(); ++i) boxes.push_back(plan.voxel_box(plan.leaf_box(i)));

  const bool marks_missing = source.info().mapping.marks_missing();
  tbb::enumerable_thread_specific<DifferenceTally> tallies;
  StreamOptions stream;
  stream.cancel = options.cancel;
  stream.trace = options.trace;
  if (options.progress) {
    stream.progress = [&](std::int64_t done, std::int64_t) {
      options.progress(static_cast<std::uint64_t>(done) * sizeof(float));
    };
  }
  const ConversionLoss loss = stream_blocks(source, boxes, stream, [&](const Block& block) {
    const TraceSpan span(options.trace, "compare", block.values.size_bytes());
    for_each_leaf(
        plan.lattice, plan.leaf_box(static_cast<std::int64_t>(block.index)), options.release_pages,
        [&](const Index3& leaf) { tallies.local().add_leaf(block, grid, plan.lattice, leaf, marks_missing); });
  });
  DifferenceTally total;
  for (const DifferenceTally& tally : tallies) total.merge(tally);
  Comparison comparison = total.result(domain);
  comparison.loss = loss;
  return comparison;
}

}  // namespace weir
