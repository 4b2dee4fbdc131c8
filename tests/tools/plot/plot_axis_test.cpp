#include "tools/plot/plot_axis.h"

#include <gtest/gtest.h>

namespace weir::plot_axis_test {
namespace {

using Ticks = std::vector<double>;

TEST(PlotAxis, StepIsTheSmallestRoundOneThatFits) {
  EXPECT_EQ(tick_step(6, 6), 1);
  EXPECT_EQ(tick_step(6.1, 6), 2);
  EXPECT_EQ(tick_step(100, 6), 20);
  EXPECT_EQ(tick_step(350, 6), 100);
  EXPECT_DOUBLE_EQ(tick_step(0.003, 6), 0.0005);
}

TEST(PlotAxis, EvenTicksCoverTheRange) {
  EXPECT_EQ(even_ticks(36.4, 131.8), (Ticks{20, 40, 60, 80, 100, 120, 140}));
  EXPECT_EQ(even_ticks(0, 100), (Ticks{0, 20, 40, 60, 80, 100}));
  EXPECT_EQ(even_ticks(-3, 3), (Ticks{-3, -2, -1, 0, 1, 2, 3}));
  const Ticks small = even_ticks(41.30, 41.34);
  EXPECT_LE(small.front(), 41.30 + 1e-9);
  EXPECT_GE(small.back(), 41.34 - 1e-9);
}

TEST(PlotAxis, RangeOfOneValue_HasTicks) {
  EXPECT_EQ(even_ticks(0, 0), (Ticks{0, 0.2}));
  const Ticks at = even_ticks(57.2, 57.2);
  ASSERT_GE(at.size(), 2U);
  EXPECT_LE(at.front(), 57.2);
  EXPECT_GE(at.back(), 57.2);
  EXPECT_EQ(decade_ticks(1, 1), (Ticks{1, 2}));
  EXPECT_EQ(decade_ticks(0.3, 0.3), (Ticks{0.2, 0.5}));
}

TEST(PlotAxis, DecadeTicksAreExactDecimals) {
  EXPECT_EQ(decade_ticks(1.6, 16), (Ticks{1, 2, 5, 10, 20}));
  EXPECT_EQ(decade_ticks(0.011, 0.3), (Ticks{0.01, 0.02, 0.05, 0.1, 0.2, 0.5}));
  EXPECT_EQ(decade_ticks(0.001, 0.001), (Ticks{0.001, 0.002}));
  EXPECT_EQ(decade_ticks(1000, 1001), (Ticks{1000, 2000}));
  EXPECT_EQ(decade_ticks(999, 1000), (Ticks{500, 1000}));
}

TEST(PlotAxis, ManyDecades_HaveTicksOnlyAtPowersOfTen) {
  EXPECT_EQ(decade_ticks(0.02, 300), (Ticks{0.01, 0.1, 1, 10, 100, 1000}));
  EXPECT_EQ(decade_ticks(0.01, 10000), (Ticks{0.01, 0.1, 1, 10, 100, 1000, 10000}));
}

TEST(PlotAxis, MinorTicksLieWithinTheRange) {
  EXPECT_EQ(minor_decade_ticks(5, 20), (Ticks{5, 6, 7, 8, 9, 10, 20}));
  EXPECT_EQ(minor_decade_ticks(0.2, 0.5), (Ticks{0.2, 0.3, 0.4, 0.5}));
  EXPECT_EQ(minor_decade_ticks(1.1, 1.9), Ticks{});
}

TEST(TickText, HasTheDigitsThatTellTicksApart) {
  EXPECT_EQ(tick_text(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(tick_text(-2, 0.5), "-2.0");
  EXPECT_EQ(tick_text(250, 50), "250");
  EXPECT_EQ(tick_text(1e-17, 0.1), "0");
  EXPECT_EQ(tick_text(-0.0, 0), "0");
  EXPECT_EQ(tick_text(1.2e-5, 2e-6), "1.2e-05");
  EXPECT_EQ(tick_text(1000000.25, 0.05), "1.00000025e+06");
  EXPECT_EQ(tick_text(3e38, 1e38), "3e+38");
  EXPECT_EQ(tick_text(7, 7), "7");
}

}  // namespace
}  // namespace weir::plot_axis_test
