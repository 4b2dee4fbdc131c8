#include "daemon/store/file_identity.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::file_identity_test {
namespace {

namespace fs = std::filesystem;

TEST(FileIdentity, IsSizeTimeAndInodeOfARegularFile) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a.raw";
  write_file(path, "12345");
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  const FileIdentity expected{5, std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec,
                              status.st_ino};
  EXPECT_EQ(identify(path), expected);
  fs::create_symlink("a.raw", directory / "link");
  EXPECT_EQ(identify(directory / "link"), expected) << "of what it leads to";
  fs::create_hard_link(path, directory / "other");
  EXPECT_EQ(identify(directory / "other"), expected);
}

TEST(FileIdentity, NotARegularFile_HasNoIdentityAndCountsAsGone) {
  const TemporaryDirectory directory;
  fs::create_directory(directory / "directory");
  ASSERT_EQ(::mkfifo((directory / "fifo").c_str(), 0600), 0);
  fs::create_symlink("nowhere", directory / "dangling");
  fs::create_symlink("loop", directory / "loop");
  write_file(directory / "file", "");
  const std::vector<std::string> names{"missing", "directory",  "fifo",         "dangling",
                                       "loop",    "file/below", "no/directory", std::string(300, 'x')};
  for (const std::string& name : names) {
    EXPECT_EQ(identify(directory / name), std::nullopt) << name;
    EXPECT_TRUE(is_gone(directory / name)) << name;
  }
  EXPECT_FALSE(is_gone(directory / "file"));
}

TEST(FileIdentity, OnlyErrorsOfThePathItselfMeanMissing) {
  for (const int error : {ENOENT, ENOTDIR, ELOOP, ENAMETOOLONG}) EXPECT_TRUE(says_missing(error)) << error;
  for (const int error : {EACCES, EIO, ESTALE, ETIMEDOUT, ENOMEM, EOVERFLOW, EHOSTDOWN}) {
    EXPECT_FALSE(says_missing(error)) << error;
  }
}

}  // namespace
}  // namespace weir::file_identity_test
