#include "daemon/watch/poll_watch.h"

#include <gtest/gtest.h>

#include <boost/asio/post.hpp>

#include "tests/daemon/support/watched_directory.h"

namespace weir::poll_watch_test {
namespace {

namespace fs = std::filesystem;
using Kind = FileEventKind;

TEST(PollWatchTest, ScanOfALargeDirectory_LetsOtherWorkRunBetween) {
  WatchedDirectory dir(WatchMethod::poll);
  for (int i = 0; i < 2000; ++i) write_file(dir / (std::to_string(i) + ".raw"), "1");
  std::vector<std::size_t> known_at_turns;
  std::function<void()> other = [&] {
    known_at_turns.push_back(dir.events.size());
    if (dir.events.size() < 2000) boost::asio::post(dir.io, other);
  };
  dir.start();
  boost::asio::post(dir.io, other);
  ASSERT_TRUE(dir.run_until([&] { return !known_at_turns.empty() && known_at_turns.back() == 2000; }));
  std::size_t longest = 0;
  for (std::size_t i = 1; i < known_at_turns.size(); ++i) {
    longest = std::max(longest, known_at_turns[i] - known_at_turns[i - 1]);
  }
  EXPECT_LE(longest, 256U);
}

TEST(PollWatchTest, UnchangedFileIsReportedOnce) {
  WatchedDirectory dir(WatchMethod::poll);
  write_file(dir / "a.raw", "1");
  dir.start();
  ASSERT_TRUE(dir.run_until_told(Kind::found, dir / "a.raw"));
  dir.run_for(std::chrono::milliseconds(200));
  EXPECT_EQ(dir.events.size(), 1U);
}

TEST(PollWatchTest, ReplacementOfTheSameSizeAndTimeIsReported) {
  WatchedDirectory dir(WatchMethod::poll);
  write_file(dir / "a.raw", "1");
  dir.start();
  ASSERT_TRUE(dir.run_until_told(Kind::found, dir / "a.raw"));
  dir.events.clear();
  write_file(dir.outside("b.raw"), "2");
  fs::last_write_time(dir.outside("b.raw"), fs::last_write_time(dir / "a.raw"));
  fs::rename(dir.outside("b.raw"), dir / "a.raw");
  EXPECT_TRUE(dir.run_until_told(Kind::found, dir / "a.raw"));
}

TEST(PollWatchTest, TimeSetBack_IsReportedAsAChange) {
  WatchedDirectory dir(WatchMethod::poll);
  write_file(dir / "a.raw", "1");
  dir.start();
  ASSERT_TRUE(dir.run_until_told(Kind::found, dir / "a.raw"));
  dir.events.clear();
  fs::last_write_time(dir / "a.raw", fs::file_time_type::clock::now() - std::chrono::hours(10000));
  EXPECT_TRUE(dir.run_until_told(Kind::found, dir / "a.raw"));
}

}  // namespace
}  // namespace weir::poll_watch_test
