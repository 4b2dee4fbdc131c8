// Tests that every kind of change to a file between two looks is found and described.
#include "ingest/files/file_state.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/temporary_directory.h"

namespace weir::file_state_test {
namespace {

namespace fs = std::filesystem;

class FileStateTest : public testing::Test {
 protected:
  FileStateTest() { write(path_, "four"); }

  static void write(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

  // Returns the message of check_unchanged() without its beginning and end, which are always the same. Returns
  // "unchanged" if it throws nothing.
  std::string found() const {
    try {
      check_unchanged(before_);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      const std::string text = error.what();
      const std::string begin = path_ + ": changed while it was read: ";
      const std::string end = "; convert it again once nothing writes to it";
      EXPECT_TRUE(text.starts_with(begin) && text.ends_with(end)) << text;
      return text.substr(begin.size(), text.size() - begin.size() - end.size());
    }
    return "unchanged";
  }
  void look() { before_ = {look_at_file(path_)}; }

  TemporaryDirectory directory_;
  std::string path_ = directory_ / "a.raw";
  std::vector<FileState> before_;
};

TEST_F(FileStateTest, UntouchedFile_IsUnchanged) {
  look();
  std::ifstream(path_).get();
  EXPECT_EQ(found(), "unchanged");
  EXPECT_EQ(before_[0].bytes, 4U);
}

TEST_F(FileStateTest, TouchedSince_WithinOneTickOfTheClock_IsTrue) {
  FileState file;
  FileState record;
  file.ctime_ns = 5'000'000'001;
  record.mtime_ns = 5'000'000'002;
  EXPECT_FALSE(touched_since(file, record));
  record.mtime_ns = file.ctime_ns;
  EXPECT_TRUE(touched_since(file, record));
  file.ctime_ns = 5'000'000'000;
  EXPECT_TRUE(touched_since(file, record)) << "a file system that counts whole seconds";
}

TEST_F(FileStateTest, AnotherSize_IsSaidWithBoth) {
  look();
  std::ofstream(path_, std::ios::app) << "more";
  EXPECT_EQ(found(), "it had 4 bytes and has 8");
}

TEST_F(FileStateTest, WrittenWithTheSameSize_IsSaidWithBothTimes) {
  fs::last_write_time(path_, fs::file_time_type::clock::from_sys(
                                 std::chrono::sys_seconds(std::chrono::sys_days(std::chrono::year(2020) / 1 / 2))));
  look();
  fs::last_write_time(path_, fs::file_time_type::clock::from_sys(
                                 std::chrono::sys_seconds(std::chrono::sys_days(std::chrono::year(2020) / 1 / 3))));
  EXPECT_EQ(found(),
            "it was written to at 2020-01-03T00:00:00.000000000Z, the last time before that at "
            "2020-01-02T00:00:00.000000000Z");
}

TEST_F(FileStateTest, WrittenAndItsTimeSetBack_IsSeenByTheChangeTime) {
  look();
  const auto time = fs::last_write_time(path_);
  while (look_at_file(path_).ctime_ns == before_[0].ctime_ns) {  // the file system's clock ticks every few ms
    write(path_, "FOUR");
    fs::last_write_time(path_, time);
  }
  EXPECT_TRUE(found().starts_with("its content, name or rights were changed at ")) << found();
}

TEST_F(FileStateTest, ReplacedByARename_IsAnotherFile) {
  look();
  write(directory_ / "b", "FOUR");
  fs::last_write_time(directory_ / "b", fs::last_write_time(path_));
  fs::rename(directory_ / "b", path_);
  EXPECT_EQ(found(), "another file has taken its place");
}

TEST_F(FileStateTest, RemovedOrAppearedFile_IsReported) {
  look();
  fs::remove(path_);
  EXPECT_EQ(found(), "it is not there any more");
  look();
  EXPECT_EQ(found(), "unchanged") << "what is missing may stay so: a virtual dataset's file";
  write(path_, "four");
  EXPECT_EQ(found(), "it was not there before");
}

}  // namespace
}  // namespace weir::file_state_test
