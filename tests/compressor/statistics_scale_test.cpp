// The statistics of 2^30 voxels against integer arithmetic: sums of a billion
// squares must not drift. The volume has a closed form and is never stored; only
// its 7063 different leaves are summed value by value.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "compressor/certificate.h"
#include "compressor/leaf_summary.h"
#include "compressor/selection.h"
#include "compressor/tree_plan.h"
#include "tests/compressor/memory_file_system.h"

namespace weir {
namespace {

__extension__ using Wide = __int128;

// Leaf k holds 10000 + k % 1009 + ((j * (k % 7 + 1)) % 64) / 64 at its j-th voxel.
constexpr std::int64_t kBases = 1009;
constexpr std::int64_t kPatterns = 7;
constexpr std::int64_t kScale = 64;  // values are integers in units of 1/64

std::int64_t scaled_value(std::int64_t leaf, std::int64_t voxel) {
  return (10000 + leaf % kBases) * kScale + voxel * (leaf % kPatterns + 1) % 64;
}

struct Exact {
  Wide count = 0;
  Wide sum = 0;      // in units of 1/64
  Wide squares = 0;  // in units of 1/4096

  void add(const Exact& other) {
    count += other.count;
    sum += other.sum;
    squares += other.squares;
  }
  double mean() const {
    return static_cast<double>(static_cast<long double>(sum) / static_cast<long double>(count) / kScale);
  }
  // Sum of (value - fill)^2, exact up to the last conversion: fill has 2^-24 as its unit at most.
  double sse_about(float fill) const {
    const auto scaled_fill = static_cast<Wide>(static_cast<double>(fill) * 0x1p24);
    const Wide unit = Wide{1} << 18U;  // 2^24 / 64
    const Wide sse = squares * unit * unit - 2 * scaled_fill * sum * unit + count * scaled_fill * scaled_fill;
    return static_cast<double>(static_cast<long double>(sse) * 0x1p-48L);
  }
};

Exact exact_leaf(std::int64_t leaf) {
  Exact exact;
  for (std::int64_t j = 0; j < 512; ++j) {
    const std::int64_t v = scaled_value(leaf, j);
    exact.add({1, v, Wide{v} * v});
  }
  return exact;
}

TEST(StatisticsScale, ABillionVoxelsKeepTwelveDigits) {
  const Box domain{{0, 0, 0}, {1024, 1024, 1024}};
  TreeRegions tree(domain);
  RowStore rows(test::MemoryFileSystem().create_unnamed("rows"), tree.leaves, 8);
  std::vector<LeafRow> kinds(kBases * kPatterns);
  std::vector<Exact> exact(kinds.size());
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    std::array<float, 512> values;
    for (std::size_t j = 0; j < 512; ++j) {
      values[j] =
          static_cast<float>(scaled_value(static_cast<std::int64_t>(kind), static_cast<std::int64_t>(j))) / kScale;
    }
    kinds[kind] = summarize_leaf(values, 0);
    exact[kind] = exact_leaf(static_cast<std::int64_t>(kind));
  }
  const auto kind_of = [&](std::int64_t leaf) { return static_cast<std::size_t>(leaf) % kinds.size(); };
  std::vector<LeafRow> run(kinds.size());
  for (std::int64_t first = 0; first < tree.leaves.size(); first += static_cast<std::int64_t>(run.size())) {
    const auto count = std::min<std::int64_t>(std::ssize(run), tree.leaves.size() - first);
    for (std::int64_t i = 0; i < count; ++i) run[static_cast<std::size_t>(i)] = kinds[kind_of(first + i)];
    rows.write(first, std::span(run).first(static_cast<std::size_t>(count)));
  }

  Selection selection(GainRule{}, rows, tree);
  Exact whole;
  std::vector<Exact> regions(tree.regions.size());
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Box box = tree.leaf_box(static_cast<std::int64_t>(r));
    for (std::int64_t n = 0; n < box.voxels(); ++n) {
      regions[r].add(exact[kind_of(tree.leaves.linear(box.lo + index_at(n, box.extent())))]);
    }
    whole.add(regions[r]);
    const TileSums& sums = tree.regions[r].sums;
    ASSERT_EQ(sums.mean, static_cast<float>(regions[r].mean()));
    ASSERT_NEAR(sums.sse, regions[r].sse_about(sums.mean), regions[r].sse_about(sums.mean) * 1e-12);
  }
  const TileSums& sums = tree.uppers[0].sums;
  EXPECT_EQ(sums.finite, 1ULL << 30U);
  EXPECT_EQ(sums.mean, static_cast<float>(whole.mean()));
  const double mean = static_cast<double>(sums.mean) + sums.residual / static_cast<double>(sums.finite);
  EXPECT_NEAR(mean, whole.mean(), whole.mean() * 1e-12);
  for (const float fill : {sums.mean, 10500.0F, 0.0F}) {
    EXPECT_NEAR(sums.sse_about(fill), whole.sse_about(fill), whole.sse_about(fill) * 1e-12) << fill;
  }

  // The certificate of the smallest tree: one tile a region, but for the corners' two.
  selection.choose(selection.bytes().minimum.file_bytes);
  ChoiceStore masks(test::MemoryFileSystem().create_unnamed("masks"), tree.region_lattice.size());
  const TreePlan plan = plan_tree(selection, rows, tree, masks);
  long double expected = 0;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    if (!tree.regions[r].open) {
      expected += static_cast<long double>(regions[r].sse_about(tree.regions[r].sums.mean));
      continue;
    }
    const Box box = tree.leaf_box(static_cast<std::int64_t>(r));
    for (std::int64_t n = 0; n < box.voxels(); ++n) {
      const std::int64_t leaf = tree.leaves.linear(box.lo + index_at(n, box.extent()));
      if (leaf == 0 || leaf + 1 == tree.leaves.size()) continue;
      expected += static_cast<long double>(exact[kind_of(leaf)].sse_about(kinds[kind_of(leaf)].mean));
    }
  }
  const Certificate certificate = make_certificate(plan.squared_error, plan.max_abs, plan.lossless, sums.finite, 0, 1);
  const auto mse = static_cast<double>(expected / 0x1p30L);
  EXPECT_NEAR(certificate.mse, mse, mse * 1e-12);
}

}  // namespace
}  // namespace weir
