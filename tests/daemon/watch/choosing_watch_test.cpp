// Tests what both watch methods must report, each with the other method disabled.
#include "daemon/watch/choosing_watch.h"
#include "daemon/config/config_names.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <random>
#include <set>

#include "tests/daemon/support/watched_directory.h"

namespace weir::directory_watch_test {
namespace {

namespace fs = std::filesystem;
using Kind = FileEventKind;

class DirectoryWatchTest : public testing::TestWithParam<WatchMethod> {
 protected:
  bool polls() const { return GetParam() == WatchMethod::poll; }

  WatchedDirectory dir{GetParam()};
};

INSTANTIATE_TEST_SUITE_P(Methods, DirectoryWatchTest, testing::Values(WatchMethod::inotify, WatchMethod::poll),
                         [](const auto& method) { return std::string(watch_method_name(method.param)); });

TEST_P(DirectoryWatchTest, FilesPresentAtStartAreFoundOnceAndNothingElse) {
  write_file(dir / "a.raw", "1");
  fs::create_directories(dir / "b/c");
  write_file(dir / "b/c/d.raw", "2");
  write_file(dir / "b/notes.txt", "3");
  fs::create_directory(dir / "e.raw");
  dir.start();
  ASSERT_TRUE(dir.run_until_told(Kind::found, dir / "b/c/d.raw"));
  dir.run_for(std::chrono::milliseconds(100));
  std::sort(dir.events.begin(), dir.events.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  EXPECT_EQ(dir.events, (std::vector<FileEvent>{{Kind::found, dir / "a.raw"}, {Kind::found, dir / "b/c/d.raw"}}));
  EXPECT_EQ(dir.notices, std::vector<std::string>{});
  EXPECT_EQ(dir.watch->method(), GetParam());
  EXPECT_TRUE(dir.watch->up());
  EXPECT_EQ(dir.watch->figures().files, 2U);
  EXPECT_EQ(dir.watch->figures().directories, 4U);
}

TEST_P(DirectoryWatchTest, SlowWriter_IsReportedFromFirstWriteToClose) {
  dir.start();
  ASSERT_TRUE(dir.settle());
  std::ofstream writer(dir / "a.raw");
  ASSERT_TRUE(dir.run_until_told(polls() ? Kind::found : Kind::created, dir / "a.raw"));
  for (int i = 0; i < 3; ++i) {
    dir.events.clear();
    writer << "more" << std::flush;
    ASSERT_TRUE(dir.run_until_told(polls() ? Kind::found : Kind::written, dir / "a.raw"));
    EXPECT_FALSE(dir.told(Kind::closed, dir / "a.raw"));
  }
  dir.events.clear();
  writer << "end";
  writer.close();
  ASSERT_TRUE(dir.run_until_written(dir / "a.raw"));
}

TEST_P(DirectoryWatchTest, ManyWritesToOneFile_AreReportedOnce) {
  dir.start();
  ASSERT_TRUE(dir.settle());
  std::ofstream writer(dir / "a.raw");
  for (int i = 0; i < 5000; ++i) writer << i << std::flush;
  writer.close();
  ASSERT_TRUE(dir.run_until_written(dir / "a.raw"));
  dir.run_for(std::chrono::milliseconds(60));
  const std::vector<Kind> once =
      polls() ? std::vector{Kind::found} : std::vector{Kind::created, Kind::written, Kind::closed};
  EXPECT_EQ(dir.kinds(dir / "a.raw"), once);
}

TEST_P(DirectoryWatchTest, FilesRenamedWithinIntoAndOutOfTheTree_AreReported) {
  write_file(dir / "a.tmp", "1");
  write_file(dir.outside("b.raw"), "2");
  dir.start();
  ASSERT_TRUE(dir.settle());
  fs::rename(dir / "a.tmp", dir / "a.raw");
  fs::rename(dir.outside("b.raw"), dir / "b.raw");
  const Kind renamed = polls() ? Kind::found : Kind::moved_in;
  ASSERT_TRUE(dir.run_until([&] { return dir.told(renamed, dir / "a.raw") && dir.told(renamed, dir / "b.raw"); }));
  dir.events.clear();
  fs::rename(dir / "a.raw", dir / "c.raw");
  fs::rename(dir / "b.raw", dir.outside("b.raw"));
  ASSERT_TRUE(
      dir.run_until([&] { return dir.told(renamed, dir / "c.raw") && dir.told(Kind::removed, dir / "b.raw"); }));
  EXPECT_TRUE(dir.told(Kind::removed, dir / "a.raw"));
}

TEST_P(DirectoryWatchTest, FileRewrittenReplacedOrRemoved_IsReported) {
  write_file(dir / "a.raw", "1");
  dir.start();
  ASSERT_TRUE(dir.settle());
  write_file(dir / "a.raw", "22");
  ASSERT_TRUE(dir.run_until_written(dir / "a.raw"));
  dir.run_for(std::chrono::milliseconds(60));
  dir.events.clear();
  write_file(dir.outside("new"), "33");  // the same length as before
  fs::rename(dir.outside("new"), dir / "a.raw");
  ASSERT_TRUE(dir.run_until_told(polls() ? Kind::found : Kind::moved_in, dir / "a.raw"));
  fs::remove(dir / "a.raw");
  ASSERT_TRUE(dir.run_until_told(Kind::removed, dir / "a.raw"));
  EXPECT_EQ(dir.watch->figures().files, 0U);
}

TEST_P(DirectoryWatchTest, FilesInNewNestedDirectories_AreReported) {
  dir.start();
  ASSERT_TRUE(dir.settle());
  std::set<std::string> paths;
  for (int i = 0; i < 50; ++i) {
    const std::string deep = dir / ("run" + std::to_string(i) + "/a/b/c");
    fs::create_directories(deep);
    paths.insert(deep + "/d.raw");
    write_file(deep + "/d.raw", "1");
  }
  const auto all_told = [&] {
    return std::all_of(paths.begin(), paths.end(), [&](const auto& path) { return dir.last(path).has_value(); });
  };
  EXPECT_TRUE(dir.run_until(all_told));
  dir.run_for(std::chrono::milliseconds(100));
  EXPECT_EQ(dir.watch->figures().directories, 201U);
  dir.events.clear();
  write_file(dir / "run49/a/b/c/late.raw", "1");  // all directories are watched from now on
  EXPECT_TRUE(dir.run_until_written(dir / "run49/a/b/c/late.raw"));
}

TEST_P(DirectoryWatchTest, DirectoriesRenamedWithinIntoAndOutOfTheTree_AreReported) {
  fs::create_directories(dir / "a/b/c");
  write_file(dir / "a/b/c/d.raw", "1");
  fs::create_directories(dir / "ab");  // a name with the same beginning
  write_file(dir / "ab/e.raw", "1");
  fs::create_directories(dir.outside("far/x"));
  write_file(dir.outside("far/x/y.raw"), "1");
  dir.start();
  ASSERT_TRUE(dir.settle());

  fs::rename(dir / "a", dir / "moved");
  ASSERT_TRUE(dir.run_until_told(Kind::found, dir / "moved/b/c/d.raw"));
  ASSERT_TRUE(dir.run_until_told(Kind::removed, dir / "a/b/c/d.raw"));
  EXPECT_EQ(dir.last(dir / "ab/e.raw"), std::nullopt);
  write_file(dir / "moved/b/c/later.raw", "1");
  ASSERT_TRUE(dir.run_until_written(dir / "moved/b/c/later.raw"));

  fs::rename(dir.outside("far"), dir / "moved/b/near");
  ASSERT_TRUE(dir.run_until_told(Kind::found, dir / "moved/b/near/x/y.raw"));

  fs::rename(dir / "moved", dir.outside("gone"));
  ASSERT_TRUE(dir.run_until_told(Kind::removed, dir / "moved/b/near/x/y.raw"));
  ASSERT_TRUE(dir.run_until_told(Kind::removed, dir / "moved/b/c/later.raw"));
  dir.events.clear();
  write_file(dir.outside("gone/b/c/unseen.raw"), "1");
  dir.run_for(std::chrono::milliseconds(100));
  EXPECT_EQ(dir.events, std::vector<FileEvent>{});
}

TEST_P(DirectoryWatchTest, SwappedDirectoriesAreToldUnderTheirNewNames) {
  for (const char* name : {"a", "b"}) fs::create_directory(dir / name);
  write_file(dir / "a/of_a.raw", "1");
  write_file(dir / "b/of_b.raw", "1");
  dir.start();
  ASSERT_TRUE(dir.settle());
  fs::rename(dir / "a", dir / "t");
  fs::rename(dir / "b", dir / "a");
  fs::rename(dir / "t", dir / "b");
  ASSERT_TRUE(dir.run_until_told(Kind::found, dir / "b/of_a.raw"));
  ASSERT_TRUE(dir.run_until_told(Kind::found, dir / "a/of_b.raw"));
  ASSERT_TRUE(dir.run_until_told(Kind::removed, dir / "a/of_a.raw"));
  ASSERT_TRUE(dir.run_until_told(Kind::removed, dir / "b/of_b.raw"));
  dir.events.clear();
  write_file(dir / "a/x.raw", "1");
  write_file(dir / "b/y.raw", "1");
  ASSERT_TRUE(dir.run_until_written(dir / "a/x.raw"));
  ASSERT_TRUE(dir.run_until_written(dir / "b/y.raw"));
}

TEST_P(DirectoryWatchTest, ExchangedOrReplacedDirectories_AreReportedAtTheirNewPaths) {
  for (const char* name : {"a", "b", "empty"}) fs::create_directory(dir / name);
  for (const char* name : {"a/of_a.raw", "b/of_b.raw", "x.raw", "y.raw"}) write_file(dir / name, name);
  dir.start();
  ASSERT_TRUE(dir.settle());
  const auto exchange = [&](const char* one, const char* other) {
    return ::renameat2(AT_FDCWD, (dir / one).c_str(), AT_FDCWD, (dir / other).c_str(), RENAME_EXCHANGE);
  };
  ASSERT_EQ(exchange("a", "b"), 0);
  ASSERT_EQ(exchange("x.raw", "y.raw"), 0);
  const auto is_there = [&](const char* name) {
    const auto last = dir.last(dir / name);
    return last.has_value() && last != Kind::removed;
  };
  ASSERT_TRUE(dir.run_until([&] { return is_there("b/of_a.raw") && is_there("a/of_b.raw") && is_there("x.raw"); }));
  ASSERT_TRUE(dir.run_until([&] { return is_there("y.raw") && dir.last(dir / "a/of_a.raw") == Kind::removed; }));
  fs::rename(dir / "a", dir / "empty");
  ASSERT_TRUE(dir.run_until([&] { return is_there("empty/of_b.raw"); }));
  dir.run_for(std::chrono::milliseconds(60));
  dir.events.clear();
  write_file(dir / "empty/later.raw", "1");
  EXPECT_TRUE(dir.run_until_written(dir / "empty/later.raw"));
}

/// Returns the files that a listener knows after these events.
std::set<std::string> listed(const std::vector<FileEvent>& events) {
  std::set<std::string> files;
  for (const FileEvent& event : events) {
    if (event.kind == Kind::removed) {
      files.erase(event.path);
    } else {
      files.insert(event.path);
    }
  }
  return files;
}

std::set<std::string> files_in(const std::string& directory) {
  std::set<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(directory)) {
    if (entry.is_regular_file()) files.insert(entry.path().string());
  }
  return files;
}

TEST_P(DirectoryWatchTest, RandomChanges_EventsMatchTheFilesThatAreThere) {
  std::mt19937 random(20251);
  const auto any = [&](int below) { return static_cast<int>(random() % static_cast<unsigned>(below)); };
  const auto any_directory = [&] {
    std::string path = dir.root();
    for (int depth = any(4); depth > 0; --depth) path += std::string("/") + "abc"[any(3)];
    return path;
  };
  const auto any_file = [&] { return any_directory() + "/" + "xy"[any(2)] + ".raw"; };
  dir.start();
  ASSERT_TRUE(dir.settle());
  for (int round = 0; round < 15; ++round) {
    for (int i = 0; i < 60; ++i) {
      std::error_code ignored;
      switch (any(8)) {
        case 0:
        case 1:
          fs::create_directories(any_directory(), ignored);
          break;
        case 2:
        case 3:
          if (const std::string path = any_file(); fs::exists(fs::path(path).parent_path())) write_file(path, "1");
          break;
        case 4:
          if (const std::string to = any_directory(); to != dir.root()) fs::rename(any_directory(), to, ignored);
          break;
        case 5:
          fs::rename(any_file(), any_file(), ignored);
          break;
        case 6:
          if (const std::string path = any_directory(); path != dir.root()) fs::remove_all(path, ignored);
          break;
        default:
          fs::remove(any_file(), ignored);
      }
      if (any(3) == 0) dir.io.poll();
    }
    ASSERT_TRUE(dir.run_until([&] { return listed(dir.events) == files_in(dir.root()); })) << "round " << round;
    EXPECT_EQ(dir.watch->figures().files, files_in(dir.root()).size());
  }
  EXPECT_EQ(dir.notices, std::vector<std::string>{});
  EXPECT_EQ(dir.watch->figures().overflows, 0U);
}

TEST(ChoosingWatchTest, AutomaticIsInotifyOnADiskOfThisMachine) {
  WatchedDirectory dir(WatchMethod::automatic);
  dir.start();
  EXPECT_EQ(dir.watch->method(), WatchMethod::inotify);
  write_file(dir / "a.raw", "1");
  EXPECT_TRUE(dir.run_until([&] { return dir.last(dir / "a.raw").has_value(); }));
  EXPECT_EQ(dir.notices, std::vector<std::string>{});
}

TEST(ChoosingWatchTest, AutomaticPollsUnknownFileSystems) {
  WatchedDirectory dir(WatchMethod::automatic);
  dir.open_inotify = no_inotify();
  dir.config.directory = "/proc/self/fdinfo";
  dir.config.poll_interval_s = 1;
  dir.start();
  EXPECT_EQ(dir.watch->method(), WatchMethod::poll);
  ASSERT_TRUE(dir.run_until([&] { return !dir.notices.empty(); }));
  EXPECT_EQ(dir.notices, std::vector<std::string>{"/proc/self/fdinfo: lies on type 0x9FA0, where inotify does not see "
                                                  "what other machines do; it is looked at every 1 s instead"});
}

}  // namespace
}  // namespace weir::directory_watch_test
