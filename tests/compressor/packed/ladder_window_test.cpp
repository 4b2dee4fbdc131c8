// Ladders of only those rungs that a window can choose. Built directly or cut down from all rungs, they are the same
// (near rungs are always built for the window). They hold what a cut in the window chooses among all rungs.
#include "compressor/packed/ladder_window.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "compressor/leaf/leaf_summary.h"
#include "compressor/packed/ladder_builder.h"

namespace weir::ladder_window_test {
namespace {

// Returns waves of many sizes, with noise, with steps or far from zero.
LeafValues block_of(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double scale = std::exp(8 * uniform(random));
  const double noise = seed % 3 == 0 ? 0 : std::exp(-6 + 5 * uniform(random));
  const double offset = seed % 4 == 0 ? 100 * uniform(random) : 0;
  const bool whole = seed % 5 == 0;
  const double kx = uniform(random), ky = uniform(random), kz = uniform(random);
  LeafValues block;
  for (unsigned i = 0; i < 512; ++i) {
    double v = std::sin(kx * (i >> 6U) + ky * (i >> 3U & 7U) + kz * (i & 7U)) + noise * uniform(random) + offset;
    if (seed % 7 == 0) v = v > 0.3 ? v : 0;
    block[i] = static_cast<float>(whole ? std::nearbyint(20 * v) : scale * v);
  }
  return block;
}

TEST(RungAbout, IsTheFirstRungOfAStepAsFine) {
  for (const std::int32_t first : {-250, -7, 0, 31, 200}) {
    for (std::int32_t wanted = -260; wanted <= 260; ++wanted) {
      std::int32_t expected = kLadderMeanRungs;
      while (expected + 1 < kLadderRungs && rung_step(first, expected) < wanted) ++expected;
      ASSERT_EQ(rung_about(first, wanted), expected) << first << ", " << wanted;
    }
  }
}

bool same_rung(const PackedRung& a, const PackedRung& b) {
  return a.bits == b.bits && a.error.value() == b.error.value();
}

constexpr double kLeastReach = 1.25;

// Returns a window about a key, for a region in which no other block has another mean.
KeyWindow window_of(const LeafRow& row, double key, double reach = KeyWindow::kMostReach) {
  return {key, row.max - row.min, reach};
}

struct Ladders {
  LeafRow row;
  PackedLadder all;
  PackedLadder within;
};

Ladders ladders_of(const LeafValues& block, double key, NearRungs near, double reach = KeyWindow::kMostReach) {
  LadderAim aim;
  aim.near_rungs = near == NearRungs::yes;
  Ladders ladders;
  ladders.row = summarize_leaf(block, 0);
  ladders.all = LadderBuilder(aim).build(block, ladders.row, near);
  aim.window = window_of(ladders.row, key, reach);
  ladders.within = LadderBuilder(aim).build(block, ladders.row, near);
  return ladders;
}

// Returns keys from those of the coarsest rungs to those of near rungs.
std::vector<double> keys_of(const LeafRow& row) {
  std::vector<double> keys;
  for (int octave = -4; octave < 40; octave += 2) keys.push_back(row.sse / 8 * std::ldexp(1.3, -octave));
  return keys;
}

// Returns a block of zeros with 4 to 64 other values next to each other.
LeafValues sparse_block_of(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  LeafValues block{};
  const std::size_t count = 4 + seed % 61;
  const std::size_t begin = seed * 7 % (block.size() - count);
  for (std::size_t i = 0; i < count; ++i) {
    block[begin + i] = static_cast<float>(std::sin(static_cast<double>(i) / 9 + seed) + 0.05 * uniform(random));
  }
  return block;
}

class LadderWindowOf : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Reaches, LadderWindowOf, testing::Values(KeyWindow::kMostReach, kLeastReach));

TEST_P(LadderWindowOf, WhatTheSurveyBuildsIsWhatIsLeftOfAllRungs) {
  for (unsigned seed = 1; seed < 120; ++seed) {
    const LeafValues block = block_of(seed);
    for (const double key : keys_of(summarize_leaf(block, 0))) {
      const Ladders ladders = ladders_of(block, key, NearRungs::no, GetParam());
      if (!(ladders.row.sse > 0)) continue;
      const KeyWindow window = window_of(ladders.row, key, GetParam());
      const LadderRange of_all = range_within(window, ladders.all, ladders.row);
      const LadderRange of_within = range_within(window, ladders.within, ladders.row);
      ASSERT_EQ(of_within.rungs.first, of_all.rungs.first) << seed << ' ' << key;
      ASSERT_EQ(of_within.rungs.end, of_all.rungs.end) << seed << ' ' << key;
      for (std::size_t rung = 0; rung < PackedLadder::kMostRungs; ++rung) {
        if (rung >= PackedLadder::kMeanRungs && !of_all.rungs.has(rung)) continue;
        ASSERT_TRUE(same_rung(ladders.within.rungs[rung], ladders.all.rungs[rung])) << seed << ' ' << rung;
      }
      ASSERT_EQ(ladders.within.exact_bytes, ladders.all.exact_bytes);
      ASSERT_EQ(ladders.within.first_step, ladders.all.first_step);
    }
  }
}

// Returns the squared error plus key times bytes of the best rung in `range`, or of the mean alone.
double least_cost(const PackedLadder& ladder, const LadderRange& range, const LeafRow& row, double key) {
  double least = row.sse + key;
  const auto add = [&](const std::optional<RungPoint>& point) {
    if (point) least = std::min(least, point->share * row.sse + key * point->bytes);
  };
  for (std::size_t rung = range.rungs.first; rung < range.rungs.end; ++rung) add(ladder.point(rung));
  for (std::size_t rung = range.near.first; rung < range.near.end; ++rung) add(ladder.near_point(rung));
  return least;
}

LadderRange all_of(const PackedLadder& ladder) {
  return {{PackedLadder::kMeanRungs, ladder.count}, {0, ladder.near_count}};
}

// Counts of cuts in windows of one reach, and of cuts with a best rung that the window does not hold.
struct Cuts {
  int all = 0;
  int worse = 0;
  double excess = 0;  // sum of the relative excess cost of these cuts
};
Cuts cuts_of(LeafValues (*make)(unsigned seed), unsigned seeds, double reach) {
  Cuts cuts;
  for (unsigned seed = 1; seed < seeds; ++seed) {
    const LeafValues block = make(seed);
    for (const double key : keys_of(summarize_leaf(block, 0))) {
      const Ladders ladders = ladders_of(block, key, NearRungs::yes, reach);
      if (!(ladders.row.sse > 0)) continue;
      const KeyWindow window = window_of(ladders.row, key, reach);
      const LadderRange range = range_within(window, ladders.all, ladders.row);
      for (const double at : {window.low(), key, window.high()}) {
        const double best = least_cost(ladders.all, all_of(ladders.all), ladders.row, at);
        const double held = least_cost(ladders.all, range, ladders.row, at);
        ++cuts.all;
        cuts.worse += held > best * 1.0000001 ? 1 : 0;
        cuts.excess += held / best - 1;
      }
    }
  }
  return cuts;
}

TEST_P(LadderWindowOf, HoldsTheBestRungOfEachCutInIt) {
  const Cuts cuts = cuts_of(block_of, 200, GetParam());
  EXPECT_GT(cuts.all, 5000);
  // Some blocks on a lattice save more with the rung after the next than with the next one.
  EXPECT_LE(cuts.worse, cuts.all / 100);
  EXPECT_LT(cuts.excess / cuts.all, 0.001);
}

// A finer rung of a block with few values takes a byte or two more. Rounded to whole bytes, one rung may be expensive
// and the next one cheap, so the search goes on beyond an expensive rung.
TEST_P(LadderWindowOf, HoldsTheBestRungOfSparseBlocks) {
  const Cuts cuts = cuts_of(sparse_block_of, 400, GetParam());
  EXPECT_GT(cuts.all, 20000);
  EXPECT_LE(cuts.worse, cuts.all / 1000);
}

TEST(LadderWindow, LeavesOutTheKindOfRungsThatIsFarBehind) {
  int near_alone = 0;
  int transform_alone = 0;
  for (unsigned seed = 1; seed < 200; ++seed) {
    const LeafRow row = summarize_leaf(block_of(seed), 0);
    for (const double key : keys_of(row)) {
      const Ladders ladders = ladders_of(block_of(seed), key, NearRungs::yes);
      if (!(row.sse > 0)) continue;
      const LadderRange range = range_within(window_of(row, key), ladders.within, row);
      const bool has_rungs = range.rungs.first < range.rungs.end;
      const bool has_near = range.near.first < range.near.end;
      near_alone += has_near && !has_rungs && ladders.all.count > PackedLadder::kMeanRungs ? 1 : 0;
      transform_alone += has_rungs && !has_near && ladders.all.near_count > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(near_alone, 50);
  EXPECT_GT(transform_alone, 500);
}

// If the means of a region are so far apart that they have no codes, rungs of the transform are of no use. The survey
// of a block does not know this.
TEST(LadderWindow, LeavesOutNeitherKindWhereMeansMayHaveNoCodes) {
  for (unsigned seed = 1; seed < 200; ++seed) {
    const LeafRow row = summarize_leaf(block_of(seed), 0);
    for (const double key : keys_of(row)) {
      if (!(row.sse > 0)) continue;
      const KeyWindow window(key, std::numeric_limits<float>::max());
      EXPECT_FALSE(window.means_have_codes());
      LadderAim aim;
      aim.near_rungs = true;
      const PackedLadder all = LadderBuilder(aim).build(block_of(seed), row, NearRungs::yes);
      const LadderRange range = range_within(window, all, row);
      const bool has_near = range.near.first < range.near.end;
      const bool has_rungs = range.rungs.first < range.rungs.end;
      EXPECT_EQ(has_near, all.near_count > 0) << seed << ' ' << key;
      EXPECT_EQ(has_rungs, all.count > PackedLadder::kMeanRungs) << seed << ' ' << key;
    }
  }
}

TEST(LadderWindow, NearRungsEndWhereTheyAreTooFine) {
  int built = 0;
  int all = 0;
  for (unsigned seed = 1; seed < 200; ++seed) {
    const LeafValues block = block_of(seed);
    const LeafRow row = summarize_leaf(block, 0);
    const Ladders ladders = ladders_of(block, row.sse / 8 * 0x1p-36, NearRungs::yes);
    for (std::size_t rung = 0; rung < PackedLadder::kMostNear; ++rung) {
      built += ladders.within.near_point(rung) ? 1 : 0;
      all += ladders.all.near_point(rung) ? 1 : 0;
      if (!ladders.within.near_point(rung) || !ladders.all.near_point(rung)) continue;
      EXPECT_EQ(ladders.within.near_point(rung)->bytes, ladders.all.near_point(rung)->bytes);
      EXPECT_EQ(ladders.within.near_point(rung)->share, ladders.all.near_point(rung)->share);
    }
  }
  EXPECT_GT(built, 100);
  EXPECT_LT(built, all / 2);
}

TEST(LadderWindow, TakesAFewRungsOfMany) {
  int built = 0;
  int all = 0;
  for (unsigned seed = 1; seed < 200; ++seed) {
    const LeafValues block = block_of(seed);
    const LeafRow row = summarize_leaf(block, 0);
    const Ladders ladders = ladders_of(block, row.sse / 8 * 0x1p-8, NearRungs::no);
    for (std::size_t rung = PackedLadder::kMeanRungs; rung < PackedLadder::kMostRungs; ++rung) {
      built += ladders.within.point(rung) ? 1 : 0;
      all += ladders.all.point(rung) ? 1 : 0;
    }
  }
  EXPECT_GT(all, 200 * 8);
  EXPECT_LT(built, all / 2);
}

}  // namespace
}  // namespace weir::ladder_window_test
