#include "daemon/disks/output_disks.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <thread>

#include "tests/support/temporary_directory.h"

namespace weir::output_disks_test {
namespace {

using std::chrono::seconds;

// Waits until the disks were looked at, and returns their figures.
std::vector<OutputDisk> looked_at(const OutputDisks& disks, OutputDisks::Time now) {
  for (int i = 0; i < 1000; ++i) {
    std::vector<OutputDisk> found = disks.disks(now);
    if (!found.empty() && !found[0].path.empty()) return found;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return {};
}

TEST(OutputDisks, PredictsWhenADiskFillsAtTheRecentRate) {
  const TemporaryDirectory directory;
  OutputDisks disks;
  const auto now = std::chrono::steady_clock::now() + seconds(10);
  EXPECT_TRUE(disks.disks(now).empty());
  const std::string first = directory.path() / "not/made/yet";
  const std::string second = directory.path() / "b";
  disks.watch({first, second, second});
  std::vector<OutputDisk> before = looked_at(disks, now);
  for (int i = 0; i < 1000 && !before.empty() && before[0].directories.size() < 2; ++i) before = looked_at(disks, now);
  ASSERT_EQ(before.size(), 1U);
  EXPECT_EQ(before[0].directories, (std::vector<std::string>{first, second}));
  EXPECT_GT(before[0].room.free, 0U);
  EXPECT_GE(before[0].room.total, before[0].room.free);
  EXPECT_EQ(before[0].written_bytes_per_s, 0);
  EXPECT_FALSE(before[0].fills_in_s.has_value());

  disks.written(second + "/below", std::uint64_t{1} << 40U, now);
  const std::vector<OutputDisk> after = disks.disks(now);
  EXPECT_NEAR(after[0].written_bytes_per_s, 0x1p40 / 10, 0x1p40 / 10 * 0.05);
  ASSERT_TRUE(after[0].fills_in_s.has_value());
  EXPECT_NEAR(*after[0].fills_in_s, static_cast<double>(after[0].room.free) / after[0].written_bytes_per_s,
              *after[0].fills_in_s * 1e-9);
}

TEST(OutputDisks, NamesTheMount) {
  OutputDisks disks;
  disks.watch({"/proc/self", "/proc/nothing/here"});
  const std::vector<OutputDisk> found = looked_at(disks, std::chrono::steady_clock::now());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].path, "/proc");
  EXPECT_EQ(found[0].room.total, 0U);
  EXPECT_FALSE(found[0].fills_in_s.has_value());
}

// A file server may answer for one directory and hang for another.
TEST(OutputDisks, LookAtASecondDirectoryDoesNotReturn_DiskIsSilent) {
  const TemporaryDirectory directory;
  struct Server {
    std::atomic<bool> hangs{false};
    std::promise<void> asked;
    std::promise<void> answer;
  };
  const auto server = std::make_shared<Server>();
  const std::string first = directory / "a";
  const std::string second = directory / "b";
  OutputDisks disks([server, second](const std::string& looked) {
    if (looked == second && server->hangs.exchange(false)) {
      server->asked.set_value();
      server->answer.get_future().wait();
    }
    return DiskRoom{1, 10, 100};
  });
  disks.watch({first, second});
  const auto now = std::chrono::steady_clock::now();
  for (int i = 0; i < 1000; ++i) {
    const std::vector<OutputDisk> found = looked_at(disks, now);
    if (!found.empty() && found[0].directories.size() == 2) break;
  }
  server->hangs = true;
  disks.watch({first, second});  // and looks at once
  server->asked.get_future().wait();
  const std::vector<OutputDisk> found = disks.disks(now + std::chrono::hours(1));
  server->answer.set_value();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].directories, (std::vector<std::string>{first, second}));
  EXPECT_NEAR(static_cast<double>(found[0].silent.count()), 3600, 60);
}

TEST(OutputDisks, RoomOfADirectory_IsLookedAtOnItsOwnThread) {
  const auto here = std::this_thread::get_id();
  const OutputDisks disks([here](const std::string& directory) {
    return std::this_thread::get_id() == here ? DiskRoom{} : DiskRoom{directory.size(), 10, 100};
  });
  EXPECT_FALSE(disks.room("/a").has_value());
  for (int i = 0; i < 1000 && !disks.room("/a"); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const std::optional<DiskRoom> room = disks.room("/a");
  ASSERT_TRUE(room.has_value());
  EXPECT_EQ(room->device, 2U);
  EXPECT_EQ(room->free, 10U);
}

TEST(OutputDisks, RoomOfADirectoryThatAJobFoundFull_IsNotThatOfBefore) {
  const auto free = std::make_shared<std::atomic<std::uint64_t>>(10);
  OutputDisks disks([free](const std::string&) { return DiskRoom{1, *free, 100}; });
  for (int i = 0; i < 1000 && !disks.room("/a"); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  *free = 3;
  disks.look_anew("/a");
  EXPECT_FALSE(disks.room("/a").has_value());
  for (int i = 0; i < 1000 && !disks.room("/a"); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(disks.room("/a")->free, 3U);
}

TEST(OutputDisks, DirectoriesChanged_KeepsKnownFigures) {
  const TemporaryDirectory directory;
  OutputDisks disks;
  disks.watch({directory.path()});
  const auto now = std::chrono::steady_clock::now();
  const std::vector<OutputDisk> before = looked_at(disks, now);
  ASSERT_EQ(before.size(), 1U);
  EXPECT_EQ(before[0].silent.count(), 0);
  disks.watch({directory.path(), "/proc/self"});
  const std::vector<OutputDisk> after = disks.disks(now);
  ASSERT_GE(after.size(), 1U);
  EXPECT_EQ(after[0].path, before[0].path);
}

}  // namespace
}  // namespace weir::output_disks_test
