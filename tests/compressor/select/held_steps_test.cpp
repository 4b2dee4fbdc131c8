#include "compressor/select/held_steps.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "compressor/packed/ladder_builder.h"
#include "compressor/select/region_rows.h"
#include "ingest/synthetic/synthetic.h"
#include "tests/compressor/support/crash_file_system.h"
#include "tests/compressor/support/surveyed.h"

namespace weir::held_steps_test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;

KeyRange keys_between(double first, double last) { return {key_bits(first), key_bits(last) + 1}; }

constexpr std::uint64_t kRegionBytes = 33'856;

// Returns a step of some leaf of a region.
HeldSteps::Step step(std::int64_t region, double key, std::uint32_t bytes, double gain) {
  return HeldSteps::Step::of_leaf(region, key, 4095, {gain, key, bytes, kExactLevel});
}

TEST(HeldSteps, KeepsStepsOfItsRangeAndSumsTheBytesOfOthers) {
  HeldSteps held(keys_between(1, 2), kMiB, kRegionBytes);
  HeldSteps::Part& part = held.part();
  part.add(HeldSteps::Step::opening(3, 1, 0.5));
  part.add(step(4, 2, 2144, 0.25));
  part.add(step(5, 0.5, 100, 1));
  part.add(step(5, 0.25, 100, 1));
  part.add(step(6, 3, 1000, 1));
  part.add(HeldSteps::Step::opening(7, kRequiredKey, 1));
  part.add(step(8, 0, 7, 0));  // never bought
  ASSERT_TRUE(held.complete());
  const auto pieces = held.steps();
  ASSERT_EQ(pieces.size(), 1U);
  ASSERT_EQ(pieces[0].size(), 2U);
  EXPECT_EQ(pieces[0][0].region, 3);
  EXPECT_TRUE(pieces[0][0].opens());
  EXPECT_EQ(pieces[0][0].bytes(kRegionBytes), kRegionBytes);
  EXPECT_EQ(pieces[0][1].region, 4);
  EXPECT_FALSE(pieces[0][1].opens());
  EXPECT_EQ(pieces[0][1].bytes(kRegionBytes), 2144U);
  EXPECT_EQ(pieces[0][1].position(), 4095U);
  EXPECT_EQ(pieces[0][1].level(), kExactLevel);
  EXPECT_EQ(pieces[0][1].gain, 0.25);
  const OutsideSums outside = held.outside();
  EXPECT_TRUE(outside[OutsideSums::below].weight == 200U);
  EXPECT_EQ(outside[OutsideSums::below].items, 2U);
  EXPECT_TRUE(outside[OutsideSums::above].weight == 1000U);
  EXPECT_TRUE(outside[OutsideSums::required].weight == kRegionBytes);
}

TEST(HeldSteps, SumsWhatOtherStepsSaveInTheUnitAskedFor) {
  constexpr double kUnit = 0.125;
  HeldSteps held(keys_between(1, 2), kMiB, kRegionBytes, false, kUnit);
  HeldSteps::Part& part = held.part();
  part.add(step(4, 1.5, 100, 4));
  part.add(step(5, 0.5, 100, 1));
  part.add(step(5, 0.25, 100, 2.3));
  part.add(step(6, 3, 1000, 5));
  part.add(HeldSteps::Step::opening(7, kRequiredKey, 0.5));
  const OutsideSums gains = held.outside_gains();
  EXPECT_TRUE(gains[OutsideSums::below].weight == 8U + 18U);
  EXPECT_EQ(gains[OutsideSums::below].items, 2U);
  EXPECT_TRUE(gains[OutsideSums::above].weight == 40U);
  EXPECT_TRUE(gains[OutsideSums::required].weight == 4U);
  EXPECT_EQ(held.unit(), kUnit);
}

TEST(HeldSteps, HoldsWhatManyThreadsAdd) {
  HeldSteps held(keys_between(1, 2), 64 * kMiB, kRegionBytes);
  constexpr std::int64_t kSteps = 100'000;
  tbb::parallel_for(std::int64_t{0}, kSteps, [&](std::int64_t i) { held.part().add(step(i, 1.5, 1, 1)); });
  ASSERT_TRUE(held.complete());
  std::vector<bool> seen(kSteps);
  std::int64_t count = 0;
  for (const auto piece : held.steps()) {
    for (const HeldSteps::Step& found : piece) {
      EXPECT_FALSE(seen[static_cast<std::size_t>(found.region)]) << found.region;
      seen[static_cast<std::size_t>(found.region)] = true;
      ++count;
    }
  }
  EXPECT_EQ(count, kSteps);
}

TEST(HeldSteps, TakesNoMoreThanItMay) {
  HeldSteps held(keys_between(1, 2), kMiB, kRegionBytes);
  std::int64_t steps = 0;
  while (held.complete() && steps < 100'000) held.part().add(step(steps++, 1.5, 1, 1));
  constexpr std::int64_t kOfAMiB = 4 * (kMiB / 4 / sizeof(HeldSteps::Step));
  EXPECT_EQ(steps, kOfAMiB + 1);
  EXPECT_TRUE(held.steps().empty());
}

TEST(HeldSteps, CountsWhatItCannotHold) {
  const KeyRange range = keys_between(1, 2);
  HeldSteps few(range, kMiB, kRegionBytes, true);
  HeldSteps many(range, kMiB / 2, kRegionBytes, true);
  KeyCounts expected(range);
  constexpr std::int64_t kSteps = 200'000;
  for (std::int64_t i = 0; i < kSteps; ++i) {
    const double key = 0.75 + static_cast<double>(i * 7919 % kSteps) / kSteps * 1.5;
    const auto bytes = static_cast<std::uint32_t>(100 + i % 7);
    expected.add(key, bytes);
    many.part().add(step(i, key, bytes, 1));
    if (i < 100) few.part().add(step(i, key, bytes, 1));
  }
  EXPECT_TRUE(few.complete());
  EXPECT_EQ(few.counts().buckets.size(), expected.buckets.size());
  ASSERT_FALSE(many.complete());
  EXPECT_TRUE(many.takes_more());
  const KeyCounts counts = many.counts();
  for (std::size_t i = 0; i < expected.buckets.size(); ++i) {
    ASSERT_EQ(counts.buckets[i].items, expected.buckets[i].items) << i;
    ASSERT_TRUE(counts.buckets[i].weight == expected.buckets[i].weight) << i;
  }
  for (std::size_t i = 0; i < counts.outside.parts.size(); ++i) {
    EXPECT_EQ(counts.outside.parts[i].items, expected.outside.parts[i].items);
  }
  EXPECT_TRUE(counts.all() == expected.all());
}

// The choice does not depend on whether no step, some steps or all steps are held.
TEST(HeldSteps, SelectionChoosesTheSameWithAndWithoutThem) {
  for (const std::string kind : {"cloud", "turbulence"}) {
    const auto source = open_synthetic(kind, {{150, 140, 260}, 3});
    test::MemoryVolume volume(*source);
    const test::Surveyed with(volume, 1U << 30U, {64, 16 * kMiB});
    const test::Surveyed without(volume, 1U << 30U, {64, 0});
    const test::Surveyed overflowing(volume, 1U << 30U, {64, kMiB / 4});
    for (const Encoding encoding : {Encoding::float32, Encoding::fpn}) {
      GainRule rule{Metric::sse, 1, {FillMode::mean, 0.25F, NonFinitePolicy::background}};
      rule.encoding = encoding;
      const test::Chooser sizes(without, rule);
      for (int k = 1; k < 8; ++k) {
        const std::uint64_t bytes =
            sizes.minimum() + (sizes.lossless() - sizes.minimum()) / 8 * static_cast<unsigned>(k);
        const test::Choice expected = test::Chooser(without, rule).choose(bytes);
        for (const test::Surveyed* const surveyed : {&with, &overflowing}) {
          const test::Choice chosen = test::Chooser(*surveyed, rule).choose(bytes);
          EXPECT_EQ(chosen.kept, expected.kept) << kind << ", " << bytes << " bytes";
          EXPECT_EQ(chosen.region, expected.region);
          EXPECT_EQ(chosen.plan.layout.content_end, expected.plan.layout.content_end);
        }
      }
    }
  }
}

// Returns how each leaf of each region is kept.
std::vector<std::vector<KeptLevel>> levels_of(const Selection& selection, const TreeRegions& tree,
                                              const RowStore& rows) {
  std::vector<std::vector<KeptLevel>> levels;
  RegionGains gains;
  RowBuffers buffers;
  for (std::size_t i = 0; i < tree.regions.size(); ++i) {
    const auto region = static_cast<std::int64_t>(i);
    const LeafChoices choices = selection.choices(region, read_region(rows, tree.leaf_box(region), buffers), gains);
    std::vector<KeptLevel>& of_region = levels.emplace_back();
    for (std::size_t position = 0; position < LeafChoices::kLeaves; ++position) {
      of_region.push_back(choices.level(position));
    }
  }
  return levels;
}

// Tests packed blocks, the widths of FpN and the paper's bricks, each for a size and for an error.
TEST(HeldSteps, LevelOfEachLeaf_IsTheOneFoundWithoutThem) {
  for (const std::string kind : {"cloud", "turbulence", "label"}) {
    const auto source = open_synthetic(kind == "label" ? "noise" : kind, {{150, 140, 260}, 3});
    test::MemoryVolume whole(*source);
    // In a volume of few values, many steps have the same key.
    test::MemoryVolume volume(whole.info().domain(), [&](const Index3& i) {
      const float v = whole.values()[static_cast<std::size_t>(linear_index(i, whole.info().domain().extent()))];
      return kind == "label" ? std::floor(v * 4) : v;
    });
    const BlockPlan plan = plan_blocks(volume.info().domain(), volume.access(), std::uint64_t{1} << 30U);
    test::CrashFileSystem files;
    RowStore with(files.create_unnamed("rows"), plan.lattice, {64, 64 * kMiB});
    with.set_ladders(std::make_unique<LeafStore<PackedLadder>>(files.create_unnamed("ladders"), plan.lattice));
    const Survey survey = survey_volume(volume, plan, with, {}, {.widths = true, .ladders = LadderAim{}});
    for (const bool packed : {true, false}) {
      for (const Metric metric : {Metric::sse, Metric::farthest}) {
        if (packed && metric != Metric::sse) continue;
        GainRule rule{metric, 2, {FillMode::mean, 0.25F, NonFinitePolicy::background}};
        rule.encoding = packed ? Encoding::packed : metric == Metric::sse ? Encoding::fpn : Encoding::float32;
        if (packed) rule.packed = PackedRule{false, coarsest_step(survey.min, survey.max)};
        TreeRegions tree(volume.info().domain());
        Selection bounds(rule, with, tree, Selection::Search::no);
        const std::uint64_t least = bounds.bytes().minimum.file_bytes;
        const std::uint64_t most = bounds.bytes().full.file_bytes;
        const auto compare = [&](Selection::Search search, const auto& choose) {
          Selection held(rule, with, tree, search);
          choose(held);
          const auto known = levels_of(held, tree, with);
          held.release_steps();
          EXPECT_EQ(known == levels_of(held, tree, with), true) << kind << (packed ? ", packed" : "");
          std::size_t kept = 0;
          for (const auto& region : known) kept += region.size() - std::ranges::count(region, KeptLevel{0});
          return kept;
        };
        std::size_t last = 0;
        for (int k = 1; k < 8; ++k) {
          const std::uint64_t bytes = least + (most - least) / 8 * static_cast<unsigned>(k);
          const std::size_t kept = compare(Selection::Search::of_bytes, [&](Selection& s) { s.choose(bytes); });
          EXPECT_GE(kept, last);
          last = kept;
        }
        EXPECT_GT(last, 0U);
        if (metric != Metric::sse) continue;
        double error = 0;
        for (const Upper& upper : tree.uppers) error += upper.tile_error;
        for (const double share : {0.5, 1e-2, 1e-4}) {
          compare(Selection::Search::of_error, [&](Selection& s) { s.choose_error(share * error); });
        }
        if (!packed) continue;
        // Only the steps of a window are held. The cut lies in the window, and for other sizes beside it.
        TreeRegions other(volume.info().domain());
        Selection first(rule, with, other);
        first.choose(least + (most - least) / 2);
        ASSERT_TRUE(first.cut_key());
        rule.packed->window = KeyWindow::about(*first.cut_key(), survey.max - survey.min);
        for (const unsigned eighths : {1U, 4U, 7U}) {
          compare(Selection::Search::of_bytes, [&](Selection& s) { s.choose(least + (most - least) / 8 * eighths); });
        }
        // The same for an error budget with a known bound of the error.
        const double range = static_cast<double>(survey.max) - static_cast<double>(survey.min);
        rule.packed->most_error = range * range * static_cast<double>(volume.info().domain().voxels());
        for (const double far : {1.0, 0x1p40}) {  // as if the background were far from all values
          rule.packed->most_error *= far;
          for (const double share : {0.5, 1e-2, 1e-4, 1e-7}) {
            Selection walked(rule, with, other, Selection::Search::no);
            walked.choose_error(share * error);
            compare(Selection::Search::of_error, [&](Selection& s) {
              s.choose_error(share * error);
              EXPECT_EQ(s.cut().threshold, walked.cut().threshold) << kind << ", " << share;
              EXPECT_EQ(s.cut().tie_region, walked.cut().tie_region);
              EXPECT_EQ(s.cut().tie_steps, walked.cut().tie_steps);
            });
          }
        }
      }
    }
  }
}

TEST(HeldSteps, AnErrorIsCutAtTheSamePlaceWithAndWithoutThem) {
  const auto source = open_synthetic("turbulence", {{150, 140, 260}, 3});
  test::MemoryVolume volume(*source);
  const test::Surveyed with(volume, 1U << 30U, {64, 16 * kMiB});
  const test::Surveyed without(volume, 1U << 30U, {64, 0});
  GainRule rule{Metric::sse, 1, {FillMode::mean, 0.25F, NonFinitePolicy::background}};
  rule.encoding = Encoding::fpn;
  double cuts = 0;
  for (const double share : {0.5, 1e-2, 1e-4}) {
    TreeRegions tree(volume.info().domain());
    TreeRegions other_tree(volume.info().domain());
    Selection held(rule, with.rows, tree, Selection::Search::of_error);
    Selection walked(rule, without.rows, other_tree);
    double error = 0;
    for (const Upper& upper : tree.uppers) error += upper.tile_error;
    held.choose_error(share * error);
    walked.choose_error(share * error);
    EXPECT_EQ(held.cut().threshold, walked.cut().threshold) << share;
    EXPECT_EQ(held.cut().tie_region, walked.cut().tie_region) << share;
    EXPECT_EQ(held.cut().tie_steps, walked.cut().tie_steps) << share;
    EXPECT_NE(held.cut().threshold, cuts) << share;
    cuts = held.cut().threshold;
  }
}

}  // namespace
}  // namespace weir::held_steps_test
