#include "compressor/resume/checkpoint.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>

namespace weir::checkpoint_test {
namespace {

Checkpoint sample() {
  Checkpoint c;
  c.identity = {{"source", "/a/\xC3\xA9.raw"}, {"--rate", "8"}};
  c.spill_directory = "/scratch/.x.work";
  c.files = {{"rows", (std::uint64_t{1} << 40U) + 1}, {"volume", 0}};
  SurveyTally& t = c.survey.tally;
  t.min = -0.0F;
  t.max = std::numeric_limits<float>::denorm_min();
  t.finite = std::numeric_limits<std::uint64_t>::max();
  t.missing = 2;
  t.non_finite = 3;
  t.first_non_finite = 4;
  t.first_non_finite_value = NAN;
  t.histogram.add(1e38F, 7);
  t.value_counts = {0, 1, std::numeric_limits<std::uint64_t>::max()};
  t.first_missing = 9;
  t.loss = {5, 6, 0.1, 8};
  c.survey.done.add({{0, 0, 0}, {1, 2, 3}});
  c.survey.done.add({{0, 5, 0}, {9, 9, 9}});
  c.ladders = {true, NearBlocks::sparse, 1.0 / 3, 1.3, 0.1F, true, true, true, 2};
  c.background = {-1e-30F, "sampled-mode", 1.0 / 3};
  c.attempt = {3, std::numeric_limits<double>::infinity(), Encoding::fp8, "iso 3", 0.3};
  c.plan.bytes[15] = std::byte{255};
  c.encoded.done.add({{0, 0, 0}, {4, 4, 4}});
  t.sums = {std::numeric_limits<std::uint64_t>::max(), 1, {2, 3, 4}};
  c.encoded.sums = {5, 6};
  return c;
}

template <typename T>
auto bits_of(T value) {
  if constexpr (sizeof(T) == 4) return std::bit_cast<std::uint32_t>(value);
  if constexpr (sizeof(T) == 8) return std::bit_cast<std::uint64_t>(value);
}

TEST(Checkpoint, ReadsBackBitForBit) {
  const Checkpoint c = sample();
  const auto back = parse_checkpoint(to_text(c));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->identity, c.identity);
  EXPECT_EQ(back->spill_directory, c.spill_directory);
  EXPECT_EQ(back->files, c.files);
  EXPECT_EQ(back->survey.done, c.survey.done);
  EXPECT_EQ(back->encoded.done, c.encoded.done);
  EXPECT_EQ(back->plan, c.plan);
  EXPECT_EQ(back->survey.tally.sums, c.survey.tally.sums);
  EXPECT_EQ(back->encoded.sums, c.encoded.sums);
  const SurveyTally& t = back->survey.tally;
  const SurveyTally& expected = c.survey.tally;
  EXPECT_EQ(bits_of(t.min), bits_of(expected.min));
  EXPECT_EQ(bits_of(t.max), bits_of(expected.max));
  EXPECT_EQ(t.finite, expected.finite);
  EXPECT_EQ(t.missing, 2U);
  EXPECT_EQ(t.non_finite, 3U);
  EXPECT_EQ(t.first_non_finite, 4);
  EXPECT_EQ(bits_of(t.first_non_finite_value), bits_of(expected.first_non_finite_value));
  EXPECT_EQ(t.histogram.counts(), expected.histogram.counts());
  EXPECT_EQ(t.histogram.first_edge(), expected.histogram.first_edge());
  EXPECT_EQ(t.histogram.bin_width(), expected.histogram.bin_width());
  EXPECT_EQ(t.value_counts, expected.value_counts);
  EXPECT_EQ(t.loss.inexact, 5U);
  EXPECT_EQ(t.loss.overflow, 6U);
  EXPECT_EQ(t.loss.max_abs_error, 0.1);
  EXPECT_EQ(t.loss.unmarked, 8U);
  EXPECT_EQ(t.first_missing, 9);
  EXPECT_EQ(bits_of(back->background->value), bits_of(-1e-30F));
  EXPECT_EQ(back->background->method, "sampled-mode");
  EXPECT_EQ(back->background->share, 1.0 / 3);
  EXPECT_TRUE(back->ladders.decided);
  EXPECT_EQ(back->ladders.near, NearBlocks::sparse);
  EXPECT_EQ(back->ladders.centre, 1.0 / 3);
  EXPECT_EQ(back->ladders.reach, 1.3);
  EXPECT_EQ(back->ladders.width, 0.1F);
  EXPECT_TRUE(back->ladders.short_of_preview);
  EXPECT_TRUE(back->ladders.built);
  EXPECT_TRUE(back->ladders.rebuilt);
  EXPECT_EQ(back->ladders.moves, 2);
  EXPECT_EQ(back->attempt->number, 3);
  EXPECT_EQ(back->attempt->planned_error, std::numeric_limits<double>::infinity());
  EXPECT_EQ(back->attempt->encoding, Encoding::fp8);
  EXPECT_EQ(back->attempt->seen, "iso 3");
  EXPECT_EQ(back->attempt->met, 0.3);
}

TEST(Checkpoint, AFreshOneHasNeitherBackgroundNorAttempt) {
  const auto back = parse_checkpoint(to_text({}));
  ASSERT_TRUE(back);
  EXPECT_FALSE(back->background);
  EXPECT_FALSE(back->attempt);
  EXPECT_TRUE(back->survey.done.empty());
  EXPECT_EQ(back->survey.tally.min, std::numeric_limits<float>::infinity());
  EXPECT_TRUE(back->survey.tally.histogram.empty());
}

TEST(Checkpoint, DamagedCheckpointIsRejected) {
  const std::string text = to_text(sample());
  EXPECT_EQ(text.substr(0, 18), "weir checkpoint 8 ");
  for (std::size_t length = 0; length < text.size(); ++length) {
    EXPECT_FALSE(parse_checkpoint(std::string_view(text).substr(0, length))) << length;
  }
  for (std::size_t at = 0; at < text.size(); ++at) {
    std::string changed = text;
    changed[at] = static_cast<char>(changed[at] ^ 4);
    EXPECT_FALSE(parse_checkpoint(changed)) << at;
  }
  EXPECT_FALSE(parse_checkpoint(text + " "));
}

}  // namespace
}  // namespace weir::checkpoint_test
