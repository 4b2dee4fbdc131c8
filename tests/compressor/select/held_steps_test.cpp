#include "compressor/select/held_steps.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ingest/synthetic/synthetic.h"
#include "tests/compressor/support/surveyed.h"

namespace weir::held_steps_test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;

KeyRange keys_between(double first, double last) { return {key_bits(first), key_bits(last) + 1}; }

constexpr std::uint64_t kRegionBytes = 33'856;

// Of some leaf of a region.
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
  const auto chunks = held.chunks();
  ASSERT_EQ(chunks.size(), 1U);
  ASSERT_EQ(chunks[0].size(), 2U);
  EXPECT_EQ(chunks[0][0].region, 3);
  EXPECT_TRUE(chunks[0][0].opens());
  EXPECT_EQ(chunks[0][0].bytes(kRegionBytes), kRegionBytes);
  EXPECT_EQ(chunks[0][1].region, 4);
  EXPECT_FALSE(chunks[0][1].opens());
  EXPECT_EQ(chunks[0][1].bytes(kRegionBytes), 2144U);
  EXPECT_EQ(chunks[0][1].position(), 4095U);
  EXPECT_EQ(chunks[0][1].level(), kExactLevel);
  EXPECT_EQ(chunks[0][1].gain, 0.25);
  const OutsideSums outside = held.outside();
  EXPECT_TRUE(outside[OutsideSums::below].weight == 200U);
  EXPECT_EQ(outside[OutsideSums::below].items, 2U);
  EXPECT_TRUE(outside[OutsideSums::above].weight == 1000U);
  EXPECT_TRUE(outside[OutsideSums::required].weight == kRegionBytes);
}

TEST(HeldSteps, HoldsWhatManyThreadsAdd) {
  HeldSteps held(keys_between(1, 2), 64 * kMiB, kRegionBytes);
  constexpr std::int64_t kSteps = 100'000;
  tbb::parallel_for(std::int64_t{0}, kSteps, [&](std::int64_t i) { held.part().add(step(i, 1.5, 1, 1)); });
  ASSERT_TRUE(held.complete());
  std::vector<bool> seen(kSteps);
  std::int64_t count = 0;
  for (const auto chunk : held.chunks()) {
    for (const HeldSteps::Step& found : chunk) {
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
  EXPECT_TRUE(held.chunks().empty());
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

// What is chosen does not depend on whether steps are held, all of them, or too few.
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
