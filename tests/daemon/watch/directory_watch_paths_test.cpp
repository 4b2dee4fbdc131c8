// Tests links, names, and directories that come and go, as both watch methods must report them.
#include "daemon/config/config_names.h"
#include "daemon/watch/choosing_watch.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <set>

#include "tests/daemon/support/watched_directory.h"

namespace weir::directory_watch_paths_test {
namespace {

namespace fs = std::filesystem;
using Kind = FileEventKind;

class DirectoryWatchPathsTest : public testing::TestWithParam<WatchMethod> {
 protected:
  bool polls() const { return GetParam() == WatchMethod::poll; }

  WatchedDirectory dir{GetParam()};
};

INSTANTIATE_TEST_SUITE_P(Methods, DirectoryWatchPathsTest, testing::Values(WatchMethod::inotify, WatchMethod::poll),
                         [](const auto& method) { return std::string(watch_method_name(method.param)); });

TEST_P(DirectoryWatchPathsTest, LinksOutOfTheTreeAreRefusedOnceAndLoopsIgnored) {
  write_file(dir.outside("far.raw"), "1");
  fs::create_directory(dir.outside("far"));
  write_file(dir.outside("far/x.raw"), "1");
  write_file(dir / "a.raw", "1");
  fs::create_symlink(dir.outside("far.raw"), dir / "far.raw");
  fs::create_directory_symlink(dir.outside("far"), dir / "far");
  fs::create_directory(dir / "sub");
  fs::create_directory_symlink("..", dir / "sub/loop");
  fs::create_symlink("self.raw", dir / "self.raw");
  fs::create_symlink("../a.raw", dir / "sub/inside.raw");
  dir.start();
  ASSERT_TRUE(dir.run_until_told(Kind::found, dir / "sub/inside.raw"));
  dir.run_for(std::chrono::milliseconds(200));
  std::set<std::string> paths;
  for (const FileEvent& event : dir.events) paths.insert(event.path);
  EXPECT_EQ(paths, (std::set<std::string>{dir / "a.raw", dir / "sub/inside.raw"}));
  const std::string line = (dir / "far.raw") + ": a symbolic link to " +
                           fs::canonical(dir.outside("far.raw")).string() +
                           ", outside the watched directory; watch that directory too";
  EXPECT_EQ(dir.notices, std::vector<std::string>{line});

  dir.notices.clear();
  fs::create_symlink(dir.outside("far/x.raw"), dir / "late.raw");
  ASSERT_TRUE(dir.run_until([&] { return !dir.notices.empty(); }));
  EXPECT_EQ(dir.last(dir / "late.raw"), std::nullopt);
  fs::create_symlink("a.raw", dir / "new.raw");
  fs::rename(dir / "new.raw", dir / "latest.raw");  // the way to replace a link
  EXPECT_TRUE(dir.run_until_told(Kind::found, dir / "latest.raw"));
}

TEST_P(DirectoryWatchPathsTest, HardLink_IsReportedOnce) {
  write_file(dir / "a.tmp", "1");
  dir.start();
  ASSERT_TRUE(dir.settle());
  fs::create_hard_link(dir / "a.tmp", dir / "a.raw");
  fs::remove(dir / "a.tmp");
  ASSERT_TRUE(dir.run_until_told(polls() ? Kind::found : Kind::created, dir / "a.raw"));
  dir.run_for(std::chrono::milliseconds(60));
  EXPECT_EQ(dir.kinds(dir / "a.raw").size(), 1U);
}

TEST_P(DirectoryWatchPathsTest, WatchedDirectoryMissingOrRemoved_IsReadOnceItIsMade) {
  fs::remove(dir.root());
  dir.start();
  ASSERT_TRUE(dir.run_until_told(Kind::root_lost, dir.root()));
  EXPECT_FALSE(dir.watch->up());
  fs::create_directory(dir.root());
  write_file(dir / "a.raw", "1");
  ASSERT_TRUE(dir.run_until_told(Kind::found, dir / "a.raw"));
  EXPECT_TRUE(dir.watch->up());
  EXPECT_EQ(dir.kinds(dir.root()), (std::vector{Kind::root_lost, Kind::root_back}));
  dir.events.clear();

  fs::remove_all(dir.root());
  ASSERT_TRUE(dir.run_until_told(Kind::root_lost, dir.root()));
  dir.events.clear();
  fs::create_directories(dir / "sub");
  write_file(dir / "sub/b.raw", "1");
  ASSERT_TRUE(dir.run_until_told(Kind::found, dir / "sub/b.raw"));
  EXPECT_EQ(dir.kinds(dir.root()), std::vector{Kind::root_back});
  dir.events.clear();
  write_file(dir / "c.raw", "1");
  EXPECT_TRUE(dir.run_until_written(dir / "c.raw"));
}

TEST_P(DirectoryWatchPathsTest, WatchedDirectoryReplacedByARename_NewOneIsWatched) {
  write_file(dir / "old.raw", "1");
  fs::create_directory(dir.outside("next"));
  write_file(dir.outside("next/new.raw"), "1");
  dir.start();
  ASSERT_TRUE(dir.settle());
  fs::rename(dir.root(), dir.outside("before"));
  fs::rename(dir.outside("next"), dir.root());
  ASSERT_TRUE(dir.run_until_told(Kind::found, dir / "new.raw"));
  ASSERT_TRUE(dir.run_until_told(Kind::removed, dir / "old.raw"));
  EXPECT_EQ(dir.kinds(dir.root()), (std::vector{Kind::root_lost, Kind::root_back}));
  dir.events.clear();
  write_file(dir.outside("before/unseen.raw"), "1");
  write_file(dir / "seen.raw", "1");
  ASSERT_TRUE(dir.run_until_written(dir / "seen.raw"));
  for (const FileEvent& event : dir.events) EXPECT_EQ(event.path, dir / "seen.raw");
}

TEST_P(DirectoryWatchPathsTest, ParentRenamedAway_DirectoryIsReportedLost) {
  fs::create_directories(dir / "run/out");
  dir.config.directory = dir / "run/out";
  dir.start();
  ASSERT_TRUE(dir.run_until([&] { return dir.watch->up(); }));
  fs::rename(dir / "run", dir / "elsewhere");
  ASSERT_TRUE(dir.run_until_told(Kind::root_lost, dir / "run/out"));
}

TEST_P(DirectoryWatchPathsTest, ExcludedFilesAreNotReported) {
  dir.config.exclude = {"skip*", "*_old.raw"};
  dir.config.excluded_paths = {dir / "nvdb"};
  for (const char* name : {"nvdb", "skipped", ".hidden", "kept"}) fs::create_directory(dir / name);
  dir.start();
  ASSERT_TRUE(dir.settle());
  for (const char* name : {"nvdb/a.raw", "skipped/a.raw", ".hidden/a.raw", "a_old.raw", ".b.raw", "c.txt",
                           "x.raw.partial", "kept/a.raw"}) {
    write_file(dir / name, "1");
    fs::rename(dir / name, (dir / name) + "2");
    fs::rename((dir / name) + "2", dir / name);
  }
  ASSERT_TRUE(dir.run_until([&] { return dir.last(dir / "kept/a.raw").has_value(); }));
  dir.run_for(std::chrono::milliseconds(60));
  for (const FileEvent& event : dir.events) EXPECT_EQ(event.path, dir / "kept/a.raw");
}

TEST_P(DirectoryWatchPathsTest, SubdirectoriesAreNotEnteredUnlessAskedFor) {
  dir.config.recursive = false;
  fs::create_directory(dir / "sub");
  dir.start();
  ASSERT_TRUE(dir.settle());
  write_file(dir / "sub/a.raw", "1");
  fs::create_directory(dir / "sub2");
  write_file(dir / "sub2/a.raw", "1");
  write_file(dir / "b.raw", "1");
  ASSERT_TRUE(dir.run_until_written(dir / "b.raw"));
  for (const FileEvent& event : dir.events) EXPECT_EQ(event.path, dir / "b.raw");
  EXPECT_EQ(dir.watch->figures().directories, 1U);
}

TEST_P(DirectoryWatchPathsTest, MarkersAreReportedUnderTheirSources) {
  dir.config.complete = Completion::marker;
  write_file(dir / "early.raw", "1");
  write_file(dir / "early.raw.done", "");
  dir.start();
  ASSERT_TRUE(dir.run_until_told(Kind::marked, dir / "early.raw"));
  write_file(dir / "late.raw", "1");
  write_file(dir / "late.raw.done", "");
  ASSERT_TRUE(dir.run_until_told(Kind::marked, dir / "late.raw"));
  write_file(dir / "notes.txt.done", "");
  fs::remove(dir / "late.raw.done");
  dir.run_for(std::chrono::milliseconds(100));
  for (const FileEvent& event : dir.events) {
    EXPECT_TRUE(event.path == dir / "early.raw" || event.path == dir / "late.raw") << event.path;
    EXPECT_NE(event.kind, Kind::removed);
  }
}

TEST_P(DirectoryWatchPathsTest, FileNamesOfAnyBytesAreReported) {
  const std::vector<std::string> names{"new\nline.raw", "\xff\xfe\x80.raw", " .raw",
                                       "-rf.raw",       "a'b\"c\\.raw",     std::string(251, 'n') + ".raw"};
  write_file(dir / ("early" + names[1]), "1");
  dir.start();
  ASSERT_TRUE(dir.run_until_told(Kind::found, dir / ("early" + names[1])));
  fs::create_directory(dir / "d\n\xff");
  for (const std::string& name : names) {
    write_file(dir / name, "1");
    write_file(dir / ("d\n\xff/" + name), "1");
  }
  EXPECT_TRUE(dir.run_until([&] {
    return std::all_of(names.begin(), names.end(), [&](const auto& name) {
      return dir.last(dir / name).has_value() && dir.last(dir / ("d\n\xff/" + name)).has_value();
    });
  }));
}

TEST_P(DirectoryWatchPathsTest, PathsTooLong_AreReportedAndOtherFilesFound) {
  // A path deeper than any path name allows, made step by step.
  const std::string name(200, 'd');
  int at = ::open(dir.root().c_str(), O_RDONLY | O_DIRECTORY);
  for (int i = 0; i < 25; ++i) {
    ASSERT_EQ(::mkdirat(at, name.c_str(), 0700), 0);
    const int below = ::openat(at, name.c_str(), O_RDONLY | O_DIRECTORY);
    ::close(at);
    at = below;
  }
  ::close(at);
  write_file(dir / "a.raw", "1");
  dir.start();
  ASSERT_TRUE(dir.run_until([&] { return !dir.notices.empty(); }));
  EXPECT_NE(dir.notices.front().find(": cannot be listed: File name too long; nothing in it is converted until it can"),
            std::string::npos);
  EXPECT_TRUE(dir.run_until_told(Kind::found, dir / "a.raw"));
  write_file(dir / "b.raw", "1");
  EXPECT_TRUE(dir.run_until_written(dir / "b.raw"));
  EXPECT_EQ(dir.notices.size(), 1U);
}

/// Root may read everything, so the permissions are tested as another user.
class SomebodyElse {
 public:
  explicit SomebodyElse(const std::string& owned) {
    if (::geteuid() != 0) return;
    for (const auto& entry : fs::recursive_directory_iterator(owned)) {
      EXPECT_EQ(::lchown(entry.path().c_str(), kNobody, kNobody), 0);
    }
    EXPECT_EQ(::lchown(owned.c_str(), kNobody, kNobody), 0);
    fs::permissions(fs::path(owned).parent_path(), fs::perms::all);
    EXPECT_EQ(::seteuid(kNobody), 0);
  }
  ~SomebodyElse() {
    if (::getuid() == 0) {
      EXPECT_EQ(::seteuid(0), 0);
    }
  }

 private:
  static constexpr uid_t kNobody = 65534;
};

TEST_P(DirectoryWatchPathsTest, UnreadableDirectory_IsReportedOnceAndReadOncePermitted) {
  fs::create_directory(dir / "locked");
  write_file(dir / "locked/a.raw", "1");
  write_file(dir / "b.raw", "1");
  SomebodyElse self(dir.root());
  fs::permissions(dir / "locked", fs::perms::none);
  dir.start();
  ASSERT_TRUE(dir.run_until_told(Kind::found, dir / "b.raw"));
  dir.run_for(std::chrono::milliseconds(200));
  EXPECT_EQ(dir.notices,
            std::vector<std::string>{(dir / "locked") +
                                     ": cannot be listed: Permission denied; nothing in it is converted until it can"});
  EXPECT_EQ(dir.last(dir / "locked/a.raw"), std::nullopt);
  fs::permissions(dir / "locked", fs::perms::owner_all);
  EXPECT_TRUE(dir.run_until_told(Kind::found, dir / "locked/a.raw"));
  dir.events.clear();
  write_file(dir / "locked/c.raw", "1");
  EXPECT_TRUE(dir.run_until_written(dir / "locked/c.raw"));
}

// rsync and tar set a link's own times right after its creation.
TEST_P(DirectoryWatchPathsTest, LinkOutOfTheTree_ItsTimesSet_StaysRefused) {
  write_file(dir.outside("a.raw"), "1");
  dir.start();
  ASSERT_TRUE(dir.settle());
  fs::create_symlink(dir.outside("a.raw"), dir / "link.raw");
  const std::array<timespec, 2> times{timespec{1000, 0}, timespec{1000, 0}};
  ASSERT_EQ(::utimensat(AT_FDCWD, (dir / "link.raw").c_str(), times.data(), AT_SYMLINK_NOFOLLOW), 0);
  ASSERT_TRUE(dir.run_until([&] { return !dir.notices.empty(); }));
  dir.run_for(std::chrono::milliseconds(200));
  EXPECT_EQ(dir.last(dir / "link.raw"), std::nullopt);
}

TEST_P(DirectoryWatchPathsTest, DestroyedWatch_ReportsNothing) {
  dir.start();
  ASSERT_TRUE(dir.settle());
  write_file(dir / "a.raw", "1");
  dir.io.poll();
  dir.watch.reset();
  dir.events.clear();
  write_file(dir / "b.raw", "1");
  dir.run_for(std::chrono::milliseconds(50));
  EXPECT_EQ(dir.events, std::vector<FileEvent>{});
}

TEST_P(DirectoryWatchPathsTest, TwoThousandFilesAtOnce) {
  dir.start();
  ASSERT_TRUE(dir.settle());
  std::set<std::string> missing;
  for (int i = 0; i < 2000; ++i) {
    const std::string path = dir / (std::to_string(i) + ".raw");
    write_file(path, "1");
    missing.insert(path);
  }
  EXPECT_TRUE(dir.run_until([&] {
    for (const FileEvent& event : dir.events) missing.erase(event.path);
    return missing.empty();
  }));
  EXPECT_EQ(dir.watch->figures().files, 2000U);
  EXPECT_EQ(dir.watch->figures().overflows, 0U);
}

}  // namespace
}  // namespace weir::directory_watch_paths_test
