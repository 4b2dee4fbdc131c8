#include "daemon/disks/recent_rate.h"

#include <gtest/gtest.h>

namespace weir::recent_rate_test {
namespace {

using std::chrono::seconds;

const RecentRate::Time kStart{std::chrono::hours(5)};

TEST(RecentRate, AveragesOverTheWindow) {
  RecentRate rate(seconds(600), kStart);
  for (int s = 0; s < 1200; s += 2) rate.add(100, kStart + seconds(s));
  const RecentRate::Rates rates = rate.at(kStart + seconds(1199));
  EXPECT_DOUBLE_EQ(rates.per_s, 0.5);
  EXPECT_DOUBLE_EQ(rates.bytes_per_s, 50);
}

TEST(RecentRate, StartedWithinTheWindow_AveragesSinceTheStart) {
  RecentRate rate(seconds(600), kStart);
  rate.add(1000, kStart + seconds(1));
  rate.add(3000, kStart + seconds(90));
  EXPECT_DOUBLE_EQ(rate.at(kStart + seconds(100)).per_s, 0.02);
  EXPECT_DOUBLE_EQ(rate.at(kStart + seconds(100)).bytes_per_s, 40);
}

TEST(RecentRate, AtTheStart_AveragesOverOneSlot) {
  RecentRate rate(seconds(600), kStart);
  rate.add(1000, kStart);
  EXPECT_DOUBLE_EQ(rate.at(kStart).per_s, 0.1);
}

TEST(RecentRate, ForgetsEntriesOlderThanTheWindow) {
  RecentRate rate(seconds(600), kStart);
  rate.add(1000, kStart + seconds(5));
  EXPECT_GT(rate.at(kStart + seconds(599)).per_s, 0);
  EXPECT_EQ(rate.at(kStart + seconds(601)).per_s, 0);
  rate.add(7, kStart + seconds(605));  // the same slot as the first event
  EXPECT_DOUBLE_EQ(rate.at(kStart + seconds(606)).bytes_per_s, 7.0 / 600);
}

}  // namespace
}  // namespace weir::recent_rate_test
