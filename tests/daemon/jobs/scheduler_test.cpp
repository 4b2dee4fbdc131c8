#include "daemon/jobs/scheduler.h"

#include <gtest/gtest.h>

#include <vector>

namespace weir::scheduler_test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint64_t kPlenty = std::uint64_t{1} << 40;
const Scheduler::Time kStart{1000h};

std::optional<std::string> none() { return std::nullopt; }

TEST(Scheduler, WatchesTakeTurns) {
  Scheduler scheduler({1, 0, 0});
  const std::vector<WatchLoad> watches{{"many", true, 0}, {"few", true, 0}, {"idle", false, 0}};
  std::string order;
  for (int i = 0; i < 6; ++i) {
    const auto label = scheduler.next(watches, kPlenty, kStart);
    ASSERT_TRUE(label);
    order += *label + ' ';
    scheduler.started(*label);
  }
  EXPECT_EQ(order, "many few many few many few ");
}

TEST(Scheduler, TheWatchWithFewerRunningGoesFirst) {
  Scheduler scheduler({4, 0, 0});
  scheduler.started("a");
  scheduler.started("b");
  const std::vector<WatchLoad> watches{{"a", true, 2}, {"b", true, 1}};
  EXPECT_EQ(scheduler.next(watches, kPlenty, kStart), "b");
}

TEST(Scheduler, StartsNoMoreJobsThanSlots) {
  Scheduler scheduler({2, 0, 0});
  std::vector<WatchLoad> watches{{"a", true, 1}, {"b", true, 1}};
  EXPECT_EQ(scheduler.next(watches, kPlenty, kStart), none());
  scheduler.set_limits({3, 0, 0});
  EXPECT_EQ(scheduler.next(watches, kPlenty, kStart), "a");
  watches = {{"a", false, 1}, {"b", false, 0}};
  EXPECT_EQ(scheduler.next(watches, kPlenty, kStart), none()) << "nothing waits";
}

TEST(Scheduler, ShortMemory_StartsNoSecondJob) {
  const Scheduler scheduler({2, 1000, 0});
  EXPECT_EQ(scheduler.next(std::vector<WatchLoad>{{"a", true, 0}}, 999, kStart), "a");
  EXPECT_EQ(scheduler.next(std::vector<WatchLoad>{{"a", true, 1}}, 999, kStart), none());
  EXPECT_EQ(scheduler.next(std::vector<WatchLoad>{{"a", true, 1}}, 1000, kStart), "a");
}

TEST(Scheduler, Paused_StartsNothingUntilResumed) {
  Scheduler scheduler({1, 0, 0});
  const std::vector<WatchLoad> watches{{"a", true, 0}};
  scheduler.pause();
  scheduler.pause();
  EXPECT_TRUE(scheduler.paused());
  EXPECT_EQ(scheduler.next(watches, kPlenty, kStart), none());
  scheduler.resume();
  EXPECT_EQ(scheduler.next(watches, kPlenty, kStart), "a");
}

TEST(Scheduler, BandwidthIsKeptOnAverageByDelayingTheNextJob) {
  Scheduler scheduler({1, 0, 100});
  const std::vector<WatchLoad> watches{{"a", true, 0}};
  scheduler.finished(1000, kStart);  // worth 10 s, however fast the job was
  EXPECT_EQ(scheduler.next(watches, kPlenty, kStart + 9s), none());
  EXPECT_EQ(scheduler.bandwidth_until(kStart + 9s), kStart + 10s);
  EXPECT_EQ(scheduler.next(watches, kPlenty, kStart + 10s), "a");
  // A job that was slower than the cap leaves neither debt nor credit.
  scheduler.finished(100, kStart + 20s);
  EXPECT_EQ(scheduler.bandwidth_until(kStart + 30s), std::nullopt);
  // Two jobs that ran at the same time share the cap.
  scheduler.finished(500, kStart + 100s);
  scheduler.finished(500, kStart + 100s);
  EXPECT_EQ(scheduler.bandwidth_until(kStart + 101s), kStart + 110s);
  scheduler.set_limits({1, 0, 0});
  EXPECT_EQ(scheduler.next(watches, kPlenty, kStart + 101s), "a") << "no cap any more";
}

}  // namespace
}  // namespace weir::scheduler_test
