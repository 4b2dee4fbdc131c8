#include "daemon/disks/full_disks.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace weir::full_disks_test {
namespace {

using namespace std::chrono_literals;
using Names = std::vector<std::string>;

const FullDisks::Time kStart{1000h};
constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;

TEST(FullDisks, JobsAsLargeOnAFullDisk_AreHeldBack) {
  FullDisks disks;
  EXPECT_TRUE(disks.empty());
  EXPECT_TRUE(disks.admits(1, 9, 100 * kMiB));
  disks.add(1, "/out", 24 * kMiB, 1, 128 * kMiB, 32 * kMiB, kStart);
  EXPECT_EQ(disks.directories(), Names{"/out"});
  EXPECT_FALSE(disks.admits(1, 9, 128 * kMiB));
  EXPECT_FALSE(disks.admits(1, 9, 100 * kMiB)) << "25 MiB of output";
  EXPECT_TRUE(disks.admits(1, 9, 96 * kMiB)) << "24 MiB of output";
  EXPECT_TRUE(disks.admits(2, 9, 128 * kMiB)) << "another file system";
}

TEST(FullDisks, SmallerJobFoundNoRoom_HoldsBackSmallerJobsToo) {
  FullDisks disks;
  disks.add(1, "/out", 24 * kMiB, 1, 128 * kMiB, 32 * kMiB, kStart);
  disks.add(1, "/out", 4 * kMiB, 2, 80 * kMiB, 20 * kMiB, kStart);
  EXPECT_FALSE(disks.admits(1, 9, 80 * kMiB));
  EXPECT_TRUE(disks.admits(1, 9, 16 * kMiB));
}

// The job waits even if its estimate is small beside another job's.
TEST(FullDisks, AJobThatFoundNoRoom_WaitsWhateverItsEstimate) {
  FullDisks disks;
  disks.add(1, "/out", 500 * kMiB, 1, 10'000 * kMiB, 1000 * kMiB, kStart);
  EXPECT_TRUE(disks.admits(1, 2, 1000 * kMiB));
  disks.add(1, "/out", 500 * kMiB, 2, 1000 * kMiB, 1000 * kMiB, kStart + 30s);
  EXPECT_FALSE(disks.admits(1, 2, 1000 * kMiB));
  const auto free_of = [](const std::string&) { return 500 * kMiB; };
  EXPECT_EQ(disks.look(free_of, kStart + FullDisks::kRetry), Names{"/out"}) << "counted from the first";
}

TEST(FullDisks, UnknownNeed_HoldsBackEveryJobOfThatDisk) {
  FullDisks disks;
  disks.add(1, "/out", 5000, 1, 128, 0, kStart);
  EXPECT_FALSE(disks.admits(1, 9, 1));
  EXPECT_TRUE(disks.admits(2, 9, 128));
}

TEST(FullDisks, AreTriedAgainWithMoreRoomOrAfterAMinute) {
  FullDisks disks;
  std::uint64_t free = 5000;
  const auto free_of = [&](const std::string&) { return free; };
  disks.add(1, "/out", 5000, 1, 128, 10'000, kStart);
  EXPECT_EQ(disks.look(free_of, kStart + 59s), Names{});
  free += FullDisks::kMoreRoom - 1;
  EXPECT_EQ(disks.look(free_of, kStart + 59s), Names{});
  ++free;
  EXPECT_EQ(disks.look(free_of, kStart + 1s), Names{"/out"});
  EXPECT_TRUE(disks.admits(1, 9, 128));
  disks.add(1, "/out", free, 1, 128, 10'000, kStart);
  EXPECT_EQ(disks.look(free_of, kStart + FullDisks::kRetry), Names{"/out"}) << "a quota shows in no figure";
  EXPECT_TRUE(disks.empty());
}

}  // namespace
}  // namespace weir::full_disks_test
