#include "daemon/watch/store_quiet.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/file_tick.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_directory.h"

namespace weir::store_quiet_test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Time = StoreQuiet::Time;

Time at(double seconds) {
  return Time{} + std::chrono::duration_cast<Time::duration>(std::chrono::duration<double>(seconds));
}

double seconds(Time time) { return std::chrono::duration<double>(time - Time{}).count(); }

class StoreQuietTest : public testing::Test {
 protected:
  StoreQuietTest() {
    fs::create_directories(store_ + "/c/0");
    write("zarr.json", "{}");
    write("c/0/0", "1234");
  }
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(store_ + '/' + name, std::ios::binary) << content;
  }
  /// Returns the answer at `when`, however many parts the look takes.
  StoreQuiet::Answer look(double when) {
    StoreQuiet::Answer answer = quiet_.look(at(when));
    while (!answer.quiet && answer.until == at(when)) answer = quiet_.look(at(when));
    return answer;
  }

  TemporaryDirectory directory_;
  std::string store_ = directory_ / "run.zarr";
  StoreQuiet quiet_{store_, 2s};
};

TEST_F(StoreQuietTest, TwoLooksWithSettleBetweenThemThatFindTheSame_AreQuiet) {
  const StoreQuiet::Answer first = look(10);
  EXPECT_FALSE(first.quiet);
  EXPECT_DOUBLE_EQ(seconds(first.until), 12);
  EXPECT_EQ(first.reason, "it has 2 files, 6 B, and may still be written");
  const StoreQuiet::Answer early = look(11);
  EXPECT_FALSE(early.quiet);
  EXPECT_DOUBLE_EQ(seconds(early.until), 12);
  EXPECT_TRUE(look(12).quiet);
}

TEST_F(StoreQuietTest, AnythingThatChangesInIt_BeginsTheTimeAnew) {
  look(0);
  double now = 2;
  const auto expect_changed = [&](const char* what) {
    const StoreQuiet::Answer answer = look(now);
    EXPECT_FALSE(answer.quiet) << what;
    EXPECT_DOUBLE_EQ(seconds(answer.until), now + 2) << what;
    EXPECT_NE(answer.reason.find("changed a moment ago"), std::string::npos) << answer.reason;
    now += 2;
    pass_file_tick();
  };
  write("c/0/1", "");
  expect_changed("a new chunk");
  write("c/0/1", "12");
  expect_changed("a longer one");
  const auto time = fs::last_write_time(store_ + "/c/0/0");
  write("c/0/0", "abcd");
  fs::last_write_time(store_ + "/c/0/0", time);
  expect_changed("as many other bytes, and the time set back");
  fs::rename(store_ + "/c/0/0", store_ + "/c/0/7");
  expect_changed("another name");
  fs::remove(store_ + "/c/0/7");
  expect_changed("one less");
  fs::create_directory(store_ + "/c/1");
  expect_changed("a directory");
  EXPECT_TRUE(look(now).quiet);
}

TEST_F(StoreQuietTest, ManyFiles_AreLookedThroughInParts) {
  for (int i = 0; i < 1500; ++i) fs::create_hard_link(store_ + "/c/0/0", store_ + "/c/" + std::to_string(100 + i));
  const StoreQuiet::Answer part = quiet_.look(at(0));
  EXPECT_FALSE(part.quiet);
  EXPECT_DOUBLE_EQ(seconds(part.until), 0);
  EXPECT_TRUE(part.reason.starts_with("its files are looked through, ")) << part.reason;
  EXPECT_EQ(quiet_.look(at(0.5)).reason, "it has 1502 files, 5.9 KiB, and may still be written");
  EXPECT_FALSE(look(1).quiet);
  EXPECT_TRUE(look(2.5).quiet);
}

TEST_F(StoreQuietTest, ADirectoryThatCannotBeListed_IsSaid) {
  fs::remove_all(store_);
  const StoreQuiet::Answer answer = quiet_.look(at(0));
  EXPECT_FALSE(answer.quiet);
  EXPECT_DOUBLE_EQ(seconds(answer.until), 2);
  EXPECT_EQ(answer.reason, "cannot be listed: No such file or directory");
}

TEST_F(StoreQuietTest, ChunksBehindALink_AreLookedThrough) {
  fs::create_directories(directory_ / "elsewhere/deep");
  fs::create_directory_symlink(directory_ / "elsewhere", store_ + "/linked");
  fs::create_symlink(directory_ / "one", store_ + "/c/0/1");
  EXPECT_EQ(look(0).reason, "it has 3 files, 6 B, and may still be written")
      << "what the link leads to is not there yet";
  std::ofstream(directory_ / "one") << "12";
  EXPECT_EQ(look(2).reason, "it has 3 files, 8 B, and changed a moment ago");
  std::ofstream(directory_ / "elsewhere/deep/chunk") << "123";
  EXPECT_EQ(look(4).reason, "it has 4 files, 11 B, and changed a moment ago");
  std::ofstream(directory_ / "elsewhere/deep/chunk") << "1234";
  EXPECT_EQ(look(6).reason, "it has 4 files, 12 B, and changed a moment ago");
  EXPECT_TRUE(look(8).quiet);
}

TEST_F(StoreQuietTest, LinksThatLeadBack_AreFollowedOnce) {
  for (const char* name : {"/self", "/c/up", "/c/0/root"}) fs::create_directory_symlink(store_, store_ + name);
  fs::create_directory(directory_ / "elsewhere");
  for (const char* name : {"elsewhere/a", "elsewhere/b"}) {
    fs::create_directory_symlink(directory_ / "elsewhere", directory_ / name);
  }
  for (const char* name : {"/x", "/y"}) fs::create_directory_symlink(directory_ / "elsewhere", store_ + name);
  std::ofstream(directory_ / "elsewhere/chunk") << "123";
  EXPECT_EQ(look(0).reason, "it has 3 files, 9 B, and may still be written");
  EXPECT_TRUE(look(2).quiet);
}

// This happens on a failing server, or if the process may open no more files.
TEST_F(StoreQuietTest, ADirectoryInItThatCannotBeListed_IsNeverQuiet) {
  if (kSanitized) GTEST_SKIP() << "the sanitizer itself opens pipes";
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const int next = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ASSERT_GE(next, 0);
  ::close(next);
  const rlimit one_more{static_cast<rlim_t>(next) + 1,
                        before.rlim_max};  // enough for the hierarchy itself, but for no directory in it
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &one_more), 0);
  std::vector<StoreQuiet::Answer> answers;
  for (int i = 0; i < 3; ++i) answers.push_back(look(2 * i));
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    EXPECT_FALSE(answers[i].quiet) << i;
    EXPECT_DOUBLE_EQ(seconds(answers[i].until), 2.0 * static_cast<double>(i) + 2) << i;
    EXPECT_EQ(answers[i].reason, "c cannot be listed: Too many open files") << i;
  }
  EXPECT_EQ(look(6).reason, "it has 2 files, 6 B, and may still be written") << "from the beginning";
  EXPECT_TRUE(look(8).quiet);
}

TEST(StoreHead, IsThatOfTheOuterDirectoryOfSuchAName) {
  for (const char* path : {"run.zarr/zarr.json", "a/run.zarr/.zgroup", "/x/run.ome.zarr/.zarray"}) {
    EXPECT_TRUE(is_store_head(path)) << path;
  }
  for (const char* path : {"run.zarr/rho/zarr.json", "run.zarr/in.zarr/zarr.json", "run/zarr.json", "run.zarr/Header",
                           "run.zarr/.zattrs", "zarr.json", ".zarr/zarr.json"}) {
    EXPECT_FALSE(is_store_head(path)) << path;
  }
  EXPECT_TRUE(is_in_store("run.zarr/c"));
  EXPECT_TRUE(is_in_store("a/run.zarr/c/0/0"));
  EXPECT_FALSE(is_in_store("a/run.zarr"));
}

}  // namespace
}  // namespace weir::store_quiet_test
