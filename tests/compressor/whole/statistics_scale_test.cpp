// Compares the statistics of 2^30 voxels with integer arithmetic, because sums of a billion squares must not drift. The
// volume has a closed form and is never stored. Only its 7063 different leaves are summed value by value, and
// quantised.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "compressor/encode/leaf_errors.h"
#include "compressor/encode/leaf_record.h"
#include "compressor/leaf/certificate.h"
#include "compressor/leaf/leaf_summary.h"
#include "compressor/leaf/quantised_leaf.h"
#include "compressor/select/selection.h"
#include "compressor/select/tree_plan.h"
#include "tests/compressor/support/crash_file_system.h"

namespace weir::statistics_scale_test {
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
  // Returns the sum of (value - fill)^2, exact up to the last conversion. `fill` must be a multiple of 2^-24.
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

constexpr std::size_t kKinds = kBases * kPatterns;
std::size_t kind_of(std::int64_t leaf) { return static_cast<std::size_t>(leaf) % kKinds; }

LeafValues values_of(std::size_t kind) {
  LeafValues values;
  for (std::size_t j = 0; j < values.size(); ++j) {
    values[j] =
        static_cast<float>(scaled_value(static_cast<std::int64_t>(kind), static_cast<std::int64_t>(j))) / kScale;
  }
  return values;
}

constexpr Box kDomain{{0, 0, 0}, {1024, 1024, 1024}};

// The volume, surveyed.
struct Billion {
  Billion() : tree(kDomain), rows(test::CrashFileSystem().create_unnamed("rows"), tree.leaves, {8, 0}), kinds(kKinds) {
    for (std::size_t kind = 0; kind < kKinds; ++kind) {
      const LeafValues values = values_of(kind);
      kinds[kind] = summarize_leaf(values, 0);
      summarize_widths(values, true, kinds[kind]);
    }
    // Leaf i has kind i % kKinds, so whole runs of kinds are written.
    for (std::int64_t first = 0; first < tree.leaves.size(); first += std::ssize(kinds)) {
      const auto count = std::min<std::int64_t>(std::ssize(kinds), tree.leaves.size() - first);
      rows.write(first, std::span(kinds).first(static_cast<std::size_t>(count)));
    }
  }

  TreeRegions tree;
  RowStore rows;
  std::vector<LeafRow> kinds;
};

TEST(StatisticsScale, ABillionVoxelsKeepTwelveDigits) {
  Billion billion;
  TreeRegions& tree = billion.tree;
  const RowStore& rows = billion.rows;
  const std::vector<LeafRow>& kinds = billion.kinds;
  std::vector<Exact> exact(kKinds);
  for (std::size_t kind = 0; kind < kKinds; ++kind) exact[kind] = exact_leaf(static_cast<std::int64_t>(kind));

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

  // The certificate of the smallest tree: one tile per region, except in the two regions of the corners.
  selection.choose(selection.bytes().minimum.file_bytes);
  ChoiceStore masks(test::CrashFileSystem().create_unnamed("masks"), tree.region_lattice.size());
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
  const Certificate certificate =
      make_certificate(plan.tiles.squared, plan.tiles.max_abs, plan.tiles.kept != Kept::lossy, sums.finite, 0, 1);
  const auto mse = static_cast<double>(expected / 0x1p30L);
  EXPECT_NEAR(certificate.mse, mse, mse * 1e-12);
}

// A file that does not exist. Writes are dropped, and reads return the records of leaves of known kinds.
class RecordsOfKinds final : public File {
 public:
  explicit RecordsOfKinds(std::vector<LeafRecord> kinds) : kinds_(std::move(kinds)) {}

  const std::string& path() const override { return path_; }
  void write_at(std::uint64_t, std::span<const std::byte>) override {}
  void read_at(std::uint64_t offset, std::span<std::byte> bytes) override {
    for (std::size_t at = 0; at < bytes.size(); at += sizeof(LeafRecord)) {
      const LeafRecord& record = kinds_[(offset + at) / sizeof(LeafRecord) % kinds_.size()];
      std::memcpy(bytes.data() + at, &record, sizeof record);
    }
  }
  bool preallocate(std::uint64_t) override { return true; }
  void clear() override {}
  void start_writeback() override {}
  void sync() override {}
  std::uint64_t size() override { return 0; }

 private:
  std::string path_ = "records";
  std::vector<LeafRecord> kinds_;
};

TEST(StatisticsScale, TheErrorOfTwoMillionQuantisedLeavesKeepsTwelveDigits) {
  Billion billion;
  GainRule rule;
  rule.encoding = Encoding::fp4;
  Selection selection(rule, billion.rows, billion.tree);
  selection.choose(selection.bytes().full.file_bytes);
  ChoiceStore choices(test::CrashFileSystem().create_unnamed("choices"), billion.tree.region_lattice.size());
  const TreePlan plan = plan_tree(selection, billion.rows, billion.tree, choices);
  const auto leaves = static_cast<std::uint64_t>(billion.tree.leaves.size());
  ASSERT_EQ(plan.layout.counts.leaves, leaves);
  EXPECT_EQ(plan.tiles.squared, 0);

  // The decoded values have 24 bits, so their differences are exact in double and the squares in long double.
  const Box node{{0, 0, 0}, {8, 8, 8}};
  std::vector<LeafRecord> records(kKinds);
  std::vector<long double> errors(kKinds);
  double max_abs = 0;
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    const LeafValues values = values_of(kind);
    const QuantisedLeaf leaf = quantise_leaf(values, values, node, node, 2);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double d = static_cast<double>(values[i]) - static_cast<double>(leaf.decoded[i]);
      errors[kind] += static_cast<long double>(d) * static_cast<long double>(d);
      max_abs = std::max(max_abs, std::abs(d));
    }
    records[kind].squared_error = leaf.squared_error;
    records[kind].max_abs = leaf.max_abs;
    records[kind].kept = leaf.kept;
  }
  long double expected = 0;
  for (std::uint64_t ordinal = 0; ordinal < leaves; ++ordinal) expected += errors[ordinal % kKinds];

  const RecordStore store(std::make_unique<RecordsOfKinds>(records), leaves);
  const DecodedErrors lost = sum_leaf_errors(billion.tree, store);
  const auto squares = static_cast<double>(expected);
  EXPECT_GT(squares, 0);
  EXPECT_NEAR(lost.squared, squares, squares * 1e-12);
  EXPECT_EQ(lost.max_abs, max_abs);
  EXPECT_EQ(lost.kept, Kept::lossy);
}

}  // namespace
}  // namespace weir::statistics_scale_test
