#include "compressor/select/selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "ingest/synthetic/synthetic.h"
#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/crash_file_system.h"
#include "tests/compressor/support/surveyed.h"

namespace weir::selection_test {
namespace {

using test::Choice;
using test::Chooser;
using test::MemoryVolume;
using test::Surveyed;

MemoryVolume synthetic(const std::string& kind, const Index3& extent) {
  const auto source = open_synthetic(kind, {extent, 3});
  return MemoryVolume(*source);
}

struct Way {
  Metric metric;
  std::int64_t brick_leaves;
  FillMode fill;
};

std::vector<Way> ways() {
  std::vector<Way> all{{Metric::sse, 1, FillMode::mean}, {Metric::sse, 1, FillMode::background}};
  for (const Metric metric : {Metric::farthest, Metric::closest, Metric::median}) {
    for (const std::int64_t brick : {1, 2, 4}) {
      all.push_back({metric, brick, FillMode::background});
      all.push_back({metric, brick, FillMode::mean});
    }
  }
  return all;
}

std::string name_of(const Way& way) {
  static const std::array<std::string, 4> metrics{"Sse", "Farthest", "Closest", "Median"};
  return metrics[static_cast<std::size_t>(way.metric)] + std::to_string(8 * way.brick_leaves) +
         (way.fill == FillMode::mean ? "Mean" : "Background");
}

std::ostream& operator<<(std::ostream& out, const Way& way) { return out << name_of(way); }

GainRule rule_of(const Way& way, float background = 0.25F) {
  return {way.metric, way.brick_leaves, {way.fill, background, NonFinitePolicy::background}};
}

// Everything that can be bought, in the order of keys. Ties go by region, then upper node, lower node, and leaves by
// gain, brick and index; the leaves of a brick are one item. Upper nodes that are worth their bytes by themselves come
// last.
struct Item {
  double key = 0;
  std::int64_t region = 0;  // a number behind all regions for an upper node that is bought for itself
  std::uint64_t bytes = 0;
  std::vector<std::int64_t> leaves;
  int upper = -1;
  int lower = -1;
};

double key_of(const GainRule& rule, const LeafGain& leaf, const Region& region) {
  if (leaf.required) return std::numeric_limits<double>::infinity();
  if (leaf.exact) return 0;
  const double own = rule.metric == Metric::sse ? leaf.first_gain() / 2144 : leaf.first_gain();
  return std::max(0x1p-1074, std::min(own, region.key));
}

std::vector<Item> sorted_items(const Chooser& chooser) {
  const TreeRegions& tree = chooser.tree();
  const GainRule& rule = chooser.selection().rule();
  std::vector<Item> items;
  const auto regions = static_cast<std::int64_t>(tree.regions.size());
  for (std::size_t u = 0; u < tree.uppers.size(); ++u) {
    // An upper node comes with the first region that has its key, or behind all regions if it is worth it by itself.
    Item item{tree.uppers[u].key, regions + static_cast<std::int64_t>(u), 270400, {}, static_cast<int>(u), -1};
    for (std::int64_t r = regions - 1; r >= 0; --r) {
      if (tree.upper_of(r) == static_cast<std::int64_t>(u) && tree.regions[static_cast<std::size_t>(r)].key == item.key)
        item.region = r;
    }
    items.push_back(item);
  }
  for (std::int64_t r = 0; r < regions; ++r) {
    const Region& region = tree.regions[static_cast<std::size_t>(r)];
    items.push_back({region.key, r, 33856, {}, -1, static_cast<int>(r)});
    const Box box = tree.leaf_box(r);
    const RegionGains gains = chooser.gains(r);
    std::vector<std::size_t> order(gains.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(-gains[a].first_gain(), gains[a].brick) < std::pair(-gains[b].first_gain(), gains[b].brick);
    });
    std::uint32_t last_brick = ~0U;
    for (const std::size_t i : order) {
      const double key = key_of(rule, gains[i], region);
      const std::int64_t leaf = tree.leaves.linear(box.lo + index_at(static_cast<std::int64_t>(i), box.extent()));
      const bool joins = items.back().region == r && !items.back().leaves.empty() && items.back().key == key &&
                         last_brick == gains[i].brick;
      if (!joins) items.push_back({key, r, 0, {}, -1, -1});
      items.back().leaves.push_back(leaf);
      items.back().bytes += 2144;
      last_brick = gains[i].brick;
    }
  }
  std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    return std::pair(-a.key, a.region) < std::pair(-b.key, b.region);
  });
  return items;
}

// Buys items from the top until one does not fit.
Choice sorted_choice(const Chooser& chooser, const std::vector<Item>& items, std::uint64_t file_bytes) {
  const TreeLayout minimum = chooser.selection().bytes().minimum;
  const NodeCounts& counts = minimum.counts;
  std::uint64_t left =
      file_bytes - (minimum.content_end - counts.uppers * 270400 - counts.lowers * 33856 - counts.leaf_bytes);
  Choice choice;
  choice.kept.resize(static_cast<std::size_t>(chooser.tree().leaves.size()));
  choice.region.resize(chooser.tree().regions.size());
  choice.upper.resize(chooser.tree().uppers.size());
  for (const Item& item : items) {
    if (item.key == 0 || item.bytes > left) break;
    left -= item.bytes;
    if (item.upper >= 0) choice.upper[static_cast<std::size_t>(item.upper)] = true;
    if (item.lower >= 0) choice.region[static_cast<std::size_t>(item.lower)] = true;
    for (const std::int64_t leaf : item.leaves) choice.kept[static_cast<std::size_t>(leaf)] = true;
  }
  return choice;
}

std::vector<std::uint64_t> spread(std::uint64_t from, std::uint64_t to, std::size_t count) {
  std::vector<std::uint64_t> sizes;
  for (std::size_t i = 0; i <= count; ++i) sizes.push_back(from + (to - from) * i / count);
  return sizes;
}

class SelectionTest : public testing::TestWithParam<Way> {};

TEST_P(SelectionTest, IsWhatSortingEverythingGives) {
  std::vector<MemoryVolume> volumes;
  volumes.push_back(synthetic("cloud", {150, 40, 135}));
  volumes.push_back(synthetic("ties", {70, 140, 20}));
  volumes.push_back(synthetic("checkerboard", {140, 30, 20}));
  volumes.push_back(synthetic("hot-voxel", {300, 20, 9}));
  volumes.push_back(MemoryVolume({{-4200, -3, 4090}, {-4000, 6, 4101}}, [](const Index3& i) {
    return i.x < -4100 ? 0.5F : static_cast<float>((i.x * i.x + i.y * 5 + i.z) % 17);
  }));
  for (MemoryVolume& volume : volumes) {
    const Surveyed surveyed(volume);
    Chooser chooser(surveyed, rule_of(GetParam()));
    const std::vector<Item> items = sorted_items(chooser);
    for (const std::uint64_t size : spread(chooser.minimum(), chooser.lossless() + 5000, 60)) {
      const Choice found = chooser.choose(size);
      const Choice expected = sorted_choice(chooser, items, size);
      ASSERT_EQ(found.kept, expected.kept) << size;
      ASSERT_EQ(found.region, expected.region) << size;
      ASSERT_EQ(found.upper, expected.upper) << size;
    }
  }
}

TEST_P(SelectionTest, ErrorAndKeptLeavesNeverGoBackwardsAsTheSizeGrows) {
  for (const std::string kind : {"cloud", "noise", "checkerboard", "ties", "sphere", "background", "nearly-constant"}) {
    MemoryVolume volume = synthetic(kind, {140, 45, 30});
    const Surveyed surveyed(volume);
    Chooser chooser(surveyed, rule_of(GetParam()));
    double error = std::numeric_limits<double>::infinity();
    Choice before;
    for (const std::uint64_t size : spread(chooser.minimum(), chooser.lossless() + 1, 300)) {
      const Choice choice = chooser.choose(size);
      EXPECT_LE(choice.plan.tiles.squared, error) << kind << ' ' << size;
      EXPECT_LE(choice.plan.layout.content_end, size) << kind;
      error = choice.plan.tiles.squared;
      const auto grows = [](const std::vector<bool>& a, const std::vector<bool>& b) {
        return a.empty() || std::equal(a.begin(), a.end(), b.begin(), std::less_equal<>());
      };
      EXPECT_TRUE(grows(before.kept, choice.kept) && grows(before.region, choice.region)) << kind << ' ' << size;
      before = choice;
    }
    EXPECT_EQ(error, 0) << kind;
    EXPECT_EQ(before.plan.tiles.kept, Kept::all) << kind;
  }
}

TEST_P(SelectionTest, PlannedErrorIsTheMeasuredOne) {
  std::vector<MemoryVolume> volumes;
  for (const std::string kind : {"cloud", "noise", "some-nan", "huge", "negative-zero", "offset", "tiny", "plateau"}) {
    volumes.push_back(synthetic(kind, {140, 25, 20}));
  }
  volumes.push_back(MemoryVolume({{-4200, -3, 4090}, {-4000, 6, 4101}}, [](const Index3& i) {
    return i.x < -4100 ? 0.1F * static_cast<float>(i.z) : static_cast<float>((i.x * i.x + i.y * 5 + i.z) % 17);
  }));
  for (MemoryVolume& volume : volumes) {
    const Surveyed surveyed(volume);
    Chooser chooser(surveyed, rule_of(GetParam(), 0.1F));
    for (const std::uint64_t size : spread(chooser.minimum(), chooser.lossless(), 6)) {
      const Choice choice = chooser.choose(size);
      const auto measured = measured_error(volume, rule_of(GetParam(), 0.1F).fill, chooser.tree(), choice);
      EXPECT_NEAR(choice.plan.tiles.squared, measured.squared, measured.squared * 1e-12) << size;
      EXPECT_EQ(choice.plan.tiles.max_abs, measured.max_abs) << size;
      EXPECT_EQ(choice.plan.tiles.kept != Kept::lossy, measured.lossless) << size;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, SelectionTest, testing::ValuesIn(ways()),
                         [](const auto& parameter) { return name_of(parameter.param); });

TEST(Selection, FindsTheCutAmongKeysThatDifferInTheirLastBits) {
  // Every region has more leaves than are sorted at once. Half of the keys share their first 16 bits, the other half
  // their first 32 bits, and every fourth key of the other half has the same value.
  const Box domain{{0, 0, 0}, {512, 512, 640}};
  RowStore rows(test::CrashFileSystem().create_unnamed("rows"), make_lattice(domain, kLeafDim), {64, 0});
  std::vector<LeafRow> all(static_cast<std::size_t>(rows.leaves().size()));
  std::mt19937_64 random(13);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto draw = random();
    const double key = draw % 2 == 0   ? 1 + static_cast<double>(draw >> 48U) * 0x1p-21
                       : draw % 4 == 1 ? 1.5 + static_cast<double>(draw >> 40U) * 0x1p-48
                                       : 1.5;
    all[i].sse = key * 2144;
    // One leaf per region is required, so that all regions are open and every leaf has its own key.
    const Index3 leaf = rows.leaves().position(static_cast<std::int64_t>(i));
    const bool first = leaf.x % 16 == 0 && leaf.y % 16 == 0 && leaf.z % 16 == 0;
    all[i].finite = first ? 511 : 512;
  }
  rows.write(0, all);
  Chooser chooser(domain, rows, {Metric::sse, 1, {FillMode::mean, 0, NonFinitePolicy::keep}});
  const std::vector<Item> items = sorted_items(chooser);
  for (const std::uint64_t size : spread(chooser.minimum(), chooser.lossless(), 17)) {
    ASSERT_TRUE(chooser.choose(size).kept == sorted_choice(chooser, items, size).kept) << size;
  }
}

TEST(Selection, KeepsTheSubsetOfLeastErrorOfAllSubsets) {
  // There are 3 x 2 x 2 leaves, two of them corners. The test tries every subset of the other ten.
  std::mt19937 random(1);
  MemoryVolume volume({{0, 0, 0}, {24, 16, 16}}, [&](const Index3& i) {
    return static_cast<float>(random() % 1000) * static_cast<float>(1 + i.x / 8 + 3 * (i.y / 8) + 5 * (i.z / 8));
  });
  const Surveyed surveyed(volume);
  Chooser chooser(surveyed, GainRule{});
  const std::vector<LeafRow> rows = surveyed.all_rows();
  std::vector<double> least(11, std::numeric_limits<double>::infinity());
  for (unsigned subset = 0; subset < 1024; ++subset) {
    double error = 0;
    for (unsigned i = 0; i < 10; ++i) error += (subset >> i & 1U) != 0 ? 0 : rows[i + 1].sse;
    const auto count = static_cast<std::size_t>(std::popcount(subset));
    least[count] = std::min(least[count], error);
  }
  for (std::size_t k = 0; k <= 10; ++k) {
    for (const std::uint64_t slack : {0U, 1U, 2143U}) {
      const Choice choice = chooser.choose(chooser.minimum() + k * 2144 + slack);
      EXPECT_EQ(choice.plan.layout.counts.leaves, k + 2 < 12 || slack == 0 ? k + 2 : 12);
      EXPECT_NEAR(choice.plan.tiles.squared, least[k], least[k] * 1e-12);
    }
  }
}

TEST(Selection, OpensARegionWhereThatSavesMostPerByte) {
  // Three regions along x: those of the corners and one between them. The test finds the best ratio over k of the
  // region between by hand.
  std::mt19937 random(2);
  MemoryVolume volume({{0, 0, 0}, {384, 8, 8}}, [&](const Index3& i) {
    return i.x < 128 || i.x >= 256 ? 0.0F : static_cast<float>(i.x / 8 + static_cast<int>(random() % 3) * (i.x % 5));
  });
  const Surveyed surveyed(volume);
  Chooser chooser(surveyed, GainRule{});
  const std::vector<LeafRow> rows = surveyed.all_rows();
  const Box middle{{128, 0, 0}, {256, 8, 8}};
  const float tile = test::expected_tile(volume, middle, FillMode::mean, 0);
  double closed = 0;
  for (const float v : volume.in(middle)) closed += std::pow(static_cast<double>(v) - static_cast<double>(tile), 2);
  std::vector<double> sse;
  for (std::size_t leaf = 16; leaf < 32; ++leaf) sse.push_back(rows[leaf].sse);
  std::sort(sse.begin(), sse.end(), std::greater<>());
  double left = std::accumulate(sse.begin(), sse.end(), 0.0);
  double best = (closed - left) / 33856;
  for (std::size_t k = 0; k < sse.size(); ++k) {
    left -= sse[k];
    best = std::max(best, (closed - left) / (33856.0 + 2144.0 * static_cast<double>(k + 1)));
  }
  EXPECT_NEAR(chooser.tree().regions[1].key, best, best * 1e-12);
}

TEST(Selection, EveryBudgetFromTheMinimumToBeyondLosslessIsMetExactly) {
  MemoryVolume volume = synthetic("cloud", {140, 20, 20});
  ConversionOptions options;
  const std::uint64_t minimum = test::minimum_size(volume, options);
  options.budget.kind = Budget::Kind::lossless;
  const std::uint64_t lossless = test::convert(volume, options).file.size();
  std::uint64_t step = 1;
  for (std::uint64_t size = minimum; size < lossless + 10000; size += step, step = step * 3 % 40009 + 2) {
    ASSERT_EQ(test::convert_to(volume, options, size).file.size(), size);
  }
  for (const std::uint64_t size : {lossless - 1, lossless, lossless + 1, lossless + 1234567}) {
    const auto converted = test::convert_to(volume, options, size);
    EXPECT_EQ(converted.file.size(), size);
    EXPECT_EQ(converted.sidecar.error.lossless, size >= lossless);
    EXPECT_EQ(converted.notices.size(), size > lossless ? 1U : 0U);
  }
}

TEST(Selection, OneByteBelowTheMinimumIsAnErrorThatNamesIt) {
  MemoryVolume volume = synthetic("noise", {20, 20, 20});
  ConversionOptions options;
  const std::uint64_t minimum = test::minimum_size(volume, options);
  // Head, one root tile, upper and lower node, two corner leaves, blind record, 2^3 macrocells.
  EXPECT_EQ(minimum, 4096U + 800 + 32 + 270400 + 33856 + 2 * 2144 + 288 + 64);
  try {
    test::convert_to(volume, options, minimum - 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::budget);
    EXPECT_EQ(std::string(error.what()),
              "out.nvdb: " + std::to_string(minimum - 1) + " bytes asked, the smallest tree for this volume takes " +
                  std::to_string(minimum) + "; ask for --size " + std::to_string(minimum) + " or more");
  }
  EXPECT_EQ(test::convert_to(volume, options, minimum).sidecar.selection.leaves_kept, 2U);
}

TEST(Selection, TiesGoByLeafIndex) {
  MemoryVolume volume = synthetic("checkerboard", {64, 64, 16});
  const Surveyed surveyed(volume);
  Chooser chooser(surveyed, GainRule{});
  for (const std::uint64_t leaves : {0U, 1U, 5U, 100U, 126U}) {
    const Choice choice = chooser.choose(chooser.minimum() + leaves * 2144);
    for (std::size_t i = 1; i + 1 < choice.kept.size(); ++i) EXPECT_EQ(choice.kept[i], i <= leaves) << leaves;
  }
}

}  // namespace
}  // namespace weir::selection_test
