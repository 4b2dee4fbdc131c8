// Tests faults of inotify: lost events and limits.
#include "daemon/watch/inotify_watch.h"

#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>

#include "format/base/error.h"
#include "format/base/text.h"
#include "tests/daemon/support/watched_directory.h"
#include "tests/support/sanitized.h"

namespace weir::inotify_watch_test {
namespace {

namespace fs = std::filesystem;
using Kind = FileEventKind;

/// Results that replace those of the system.
struct Faults {
  int watches_left = 1 << 30;
  int add_error = ENOSPC;
  std::size_t events_until_overflow = std::size_t{1} << 30U;  ///< per reading; further events are lost
  bool read_fails = false;
  bool cannot_be_waited_for = false;
};

class FaultyInotify final : public Inotify {
 public:
  explicit FaultyInotify(std::shared_ptr<Faults> faults) : faults_(std::move(faults)), real_(open_system_inotify()) {}

  int descriptor() const override { return faults_->cannot_be_waited_for ? -1 : real_->descriptor(); }
  int add(const std::string& directory) override {
    return faults_->watches_left-- > 0 ? real_->add(directory) : -faults_->add_error;
  }
  void remove(int watch) override { real_->remove(watch); }
  std::size_t read(std::span<std::byte> events) override {
    if (faults_->read_fails) throw Error(ErrorKind::io, "inotify: read its queue: Input/output error");
    const std::size_t bytes = real_->read(events);
    std::size_t count = 0;
    for (std::size_t at = 0; at < bytes;) {
      inotify_event event{};
      std::memcpy(&event, events.data() + at, sizeof event);
      if (++count > faults_->events_until_overflow) {
        event = {-1, IN_Q_OVERFLOW, 0, 0};
        std::memcpy(events.data() + at, &event, sizeof event);
        return at + sizeof event;
      }
      at += sizeof event + event.len;
    }
    return bytes;
  }

 private:
  std::shared_ptr<Faults> faults_;
  std::unique_ptr<Inotify> real_;
};

/// Opens the system's inotify with a queue of `events`. The limit is machine-wide and changed only for a moment,
/// because a queue keeps the limit of its creation.
std::unique_ptr<Inotify> open_small_queue(int events) {
  const std::string path = "/proc/sys/fs/inotify/max_queued_events";
  int before = 0;
  std::ifstream(path) >> before;
  std::ofstream(path) << events;
  std::unique_ptr<Inotify> queue = open_system_inotify();
  std::ofstream(path) << before;
  return queue;
}

class InotifyWatchTest : public testing::Test {
 protected:
  void start() {
    dir.open_inotify = [this] { return std::make_unique<FaultyInotify>(faults); };
    dir.start();
  }
  std::string notice(const std::string& reason) const {
    return dir.root() + ": " + reason + "; it is looked at every 0.02 s instead";
  }

  WatchedDirectory dir{WatchMethod::inotify};
  std::shared_ptr<Faults> faults = std::make_shared<Faults>();
};

TEST_F(InotifyWatchTest, Overflow_IsReportedAndLostChangesAreFound) {
  fs::create_directory(dir / "sub");
  write_file(dir / "old.raw", "1");
  write_file(dir / "gone.raw", "1");
  start();
  ASSERT_TRUE(dir.settle());
  faults->events_until_overflow = 1;
  write_file(dir / "first.raw", "1");
  write_file(dir / "rewritten.raw", "1");
  fs::remove(dir / "gone.raw");
  fs::create_directories(dir / "new/deep");
  write_file(dir / "new/deep/a.raw", "1");
  fs::rename(dir / "sub", dir / "renamed");
  write_file(dir / "renamed/b.raw", "1");
  ASSERT_TRUE(dir.run_until_told(Kind::overflow, dir.root()));
  faults->events_until_overflow = 1U << 30U;
  ASSERT_TRUE(dir.run_until([&] { return dir.told(Kind::found, dir / "renamed/b.raw"); }));
  dir.run_for(std::chrono::milliseconds(60));
  EXPECT_EQ(dir.watch->figures().overflows, 1U);
  EXPECT_TRUE(dir.told(Kind::found, dir / "rewritten.raw"));
  EXPECT_TRUE(dir.told(Kind::found, dir / "new/deep/a.raw"));
  EXPECT_TRUE(dir.told(Kind::removed, dir / "gone.raw"));
  EXPECT_EQ(dir.kinds(dir / "first.raw"), (std::vector{Kind::created, Kind::found}));  // its close event was lost
  EXPECT_EQ(dir.kinds(dir / "old.raw"), std::vector<Kind>{});                          // unchanged
  dir.events.clear();
  write_file(dir / "renamed/later.raw", "1");
  EXPECT_TRUE(dir.run_until_told(Kind::closed, dir / "renamed/later.raw"));
  EXPECT_EQ(dir.watch->method(), WatchMethod::inotify);
}

TEST_F(InotifyWatchTest, FileWrittenDuringTheScan_IsReportedByItsEventsAlone) {
  start();
  write_file(dir / "early.raw", "1");
  ASSERT_TRUE(dir.run_until([&] { return dir.watch->figures().directories == 1; }));  // watched, not fully listed
  std::ofstream writer(dir / "slow.raw");
  writer << "1" << std::flush;
  ASSERT_TRUE(dir.run_until_told(Kind::written, dir / "slow.raw"));
  dir.run_for(std::chrono::milliseconds(60));
  EXPECT_EQ(dir.last(dir / "slow.raw"), Kind::written);
}

TEST_F(InotifyWatchTest, TwoThousandFilesThroughASmallQueue) {
  if (::access("/proc/sys/fs/inotify/max_queued_events", W_OK) != 0) {
    GTEST_SKIP() << "fs.inotify.max_queued_events may not be set here";
  }
  dir.open_inotify = [] { return open_small_queue(16); };
  dir.start();
  ASSERT_TRUE(dir.settle());
  std::set<std::string> missing;
  for (int i = 0; i < 2000; ++i) {
    const std::string path = dir / cat("d", i % 7, "/", i, ".raw");
    fs::create_directories(fs::path(path).parent_path());
    write_file(path, "1");
    missing.insert(path);
    if (i % 100 == 0) dir.run_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(dir.run_until([&] {
    for (const FileEvent& event : dir.events) missing.erase(event.path);
    return missing.empty();
  }));
  EXPECT_GE(dir.watch->figures().overflows, 1U);
  EXPECT_EQ(dir.watch->figures().files, 2000U);
  // No file still waits for a close event that was lost.
  ASSERT_TRUE(dir.run_until([&] {
    for (int i = 0; i < 2000; ++i) {
      const auto last = dir.last(dir / cat("d", i % 7, "/", i, ".raw"));
      if (last == Kind::created || last == Kind::written) return false;
    }
    return true;
  }));
}

TEST_F(InotifyWatchTest, LimitOfWatchesReached_PollsTheTreeAndSaysSo) {
  for (const char* name : {"a", "b", "c"}) fs::create_directory(dir / name);
  write_file(dir / "c/x.raw", "1");
  dir.config.poll_interval_s = 0.02;
  faults->watches_left = 2;
  start();
  ASSERT_TRUE(dir.run_until([&] { return dir.watch->method() == WatchMethod::poll; }));
  ASSERT_TRUE(dir.run_until_told(Kind::found, dir / "c/x.raw"));
  EXPECT_EQ(dir.notices, std::vector<std::string>{notice(
                             "inotify watches no further directory (the limit is fs.inotify.max_user_watches)")});
  write_file(dir / "b/y.raw", "1");
  EXPECT_TRUE(dir.run_until_told(Kind::found, dir / "b/y.raw"));
  dir.watch->choose_again();  // the limit is still as low
  dir.notices.clear();
  ASSERT_TRUE(dir.run_until([&] { return dir.watch->method() == WatchMethod::poll && !dir.notices.empty(); }));
  faults->watches_left = 1000;
  dir.watch->choose_again();
  EXPECT_EQ(dir.watch->method(), WatchMethod::inotify);
  ASSERT_TRUE(dir.run_until([&] { return dir.watch->figures().directories == 4; }));
  dir.events.clear();
  write_file(dir / "c/z.raw", "1");
  EXPECT_TRUE(dir.run_until_told(Kind::closed, dir / "c/z.raw"));
}

TEST_F(InotifyWatchTest, LimitOfWatchesReachedLater_LosesNoKnownFile) {
  dir.config.poll_interval_s = 0.02;
  start();
  ASSERT_TRUE(dir.settle());
  std::ofstream writer(dir / "open.raw");
  writer << "1" << std::flush;
  write_file(dir / "short-lived.raw", "1");
  ASSERT_TRUE(dir.run_until_told(Kind::closed, dir / "short-lived.raw"));
  faults->watches_left = 0;
  fs::remove(dir / "short-lived.raw");
  fs::create_directory(dir / "sub");
  write_file(dir / "sub/a.raw", "1");
  ASSERT_TRUE(dir.run_until_told(Kind::found, dir / "sub/a.raw"));
  ASSERT_TRUE(dir.run_until_told(Kind::removed, dir / "short-lived.raw"));
  EXPECT_TRUE(dir.run_until_told(Kind::found, dir / "open.raw"));  // its close will not be seen
  EXPECT_EQ(dir.notices.size(), 1U);
}

TEST_F(InotifyWatchTest, MissingOrFailingInotifyQueue_FallsBackToPolling) {
  dir.config.poll_interval_s = 0.02;
  write_file(dir / "a.raw", "1");
  const std::string refused = "inotify: open a queue (fs.inotify.max_user_instances limits them): Too many open files";
  dir.open_inotify = [&]() -> std::unique_ptr<Inotify> { throw Error(ErrorKind::io, refused); };
  dir.start();
  EXPECT_TRUE(dir.run_until_told(Kind::found, dir / "a.raw"));
  EXPECT_EQ(dir.notices, std::vector<std::string>{notice(refused)});
  dir.notices.clear();
  dir.events.clear();

  start();
  ASSERT_TRUE(dir.settle());
  faults->read_fails = true;
  write_file(dir / "b.raw", "1");
  EXPECT_TRUE(dir.run_until_told(Kind::found, dir / "b.raw"));
  EXPECT_EQ(dir.notices, std::vector<std::string>{notice("inotify: read its queue: Input/output error")});
}

TEST_F(InotifyWatchTest, QueueThatCannotBeWaitedFor_FallsBackToPolling) {
  dir.config.poll_interval_s = 0.02;
  faults->cannot_be_waited_for = true;
  write_file(dir / "a.raw", "1");
  start();
  EXPECT_TRUE(dir.run_until_told(Kind::found, dir / "a.raw"));
  EXPECT_EQ(dir.notices, std::vector<std::string>{notice("inotify: its events cannot be waited for (the limit is "
                                                         "fs.epoll.max_user_watches): Bad file descriptor")});
}

TEST_F(InotifyWatchTest, RefusedInotifyQueue_NamesTheSystemLimit) {
  if (kSanitized) GTEST_SKIP() << "without descriptors the sanitizer takes an exception for no object";
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit none{0, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  try {
    open_system_inotify();
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "inotify: cannot open a queue (fs.inotify.max_user_instances limits them): Too many open files");
  }
  EXPECT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
}

TEST_F(InotifyWatchTest, DirectoryMountedTwice_IsPolled) {
  fs::create_directories(dir / "a");
  fs::create_directories(dir / "b");
  if (::mount((dir / "a").c_str(), (dir / "b").c_str(), nullptr, MS_BIND, nullptr) != 0) {
    GTEST_SKIP() << "may not mount here: " << std::strerror(errno);
  }
  dir.config.poll_interval_s = 0.02;
  start();
  EXPECT_TRUE(dir.run_until([&] { return dir.watch->method() == WatchMethod::poll; }));
  write_file(dir / "a/x.raw", "1");
  EXPECT_TRUE(dir.run_until_told(Kind::found, dir / "a/x.raw"));
  EXPECT_TRUE(dir.run_until_told(Kind::found, dir / "b/x.raw"));
  dir.watch.reset();
  EXPECT_EQ(::umount((dir / "b").c_str()), 0);
}

TEST_F(InotifyWatchTest, MountOverTheDirectory_AndUnmount_AreNoticed) {
  write_file(dir / "below.raw", "1");
  start();
  ASSERT_TRUE(dir.settle());
  if (::mount("none", dir.root().c_str(), "tmpfs", 0, "size=1m") != 0) {
    GTEST_SKIP() << "may not mount here: " << std::strerror(errno);
  }
  write_file(dir / "above.raw", "1");
  EXPECT_TRUE(dir.run_until_told(Kind::found, dir / "above.raw"));
  EXPECT_TRUE(dir.told(Kind::root_lost, dir.root()));
  dir.events.clear();
  EXPECT_EQ(::umount2(dir.root().c_str(), MNT_DETACH), 0);
  EXPECT_TRUE(dir.run_until_told(Kind::found, dir / "below.raw"));
  EXPECT_TRUE(dir.told(Kind::removed, dir / "above.raw"));
}

}  // namespace
}  // namespace weir::inotify_watch_test
