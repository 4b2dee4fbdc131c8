#include "daemon/config/token_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "tests/support/message_of_error.h"
#include "tests/support/temporary_directory.h"
#include "tests/support/unreadable_file.h"

namespace weir::token_file_test {
namespace {

TEST(TokenFile, Directory_IsRefused) {
  const TemporaryDirectory directory;
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { read_token_file(directory.path()); }),
            directory.path().string() + ": is a directory; name a file with the token");
}

TEST(TokenFile, PipeOrLargeFile_IsRefused) {
  const TemporaryDirectory directory;
  const std::string pipe = directory / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { read_token_file(pipe); }),
            pipe + ": is no regular file, and weir watch reads it again at each reload; name a file");
  const std::string large = directory / "large";
  write_file(large, std::string(4097, 'a'));
  std::filesystem::permissions(large, std::filesystem::perms::owner_read);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { read_token_file(large); }),
            large + ": has more than 4096 bytes, no such file needs as many; name another");
}

TEST(TokenFile, MissingFile_IsAnInputError) {
  const TemporaryDirectory directory;
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { read_token_file(directory / "none"); }),
            (directory / "none") + ": cannot read the token: No such file or directory");
}

TEST(TokenFile, FileThatMayNotBeRead_IsAnIoError) {
  const std::string path = unreadable_file();
  if (path.empty()) GTEST_SKIP() << "this system has no file that root may not read";
  EXPECT_EQ(
      message_of_error(ErrorKind::io, [&] { read_token_file(path); }),
      path + ": cannot read: Permission denied; give this user the right to read it and to enter its directories");
}

}  // namespace
}  // namespace weir::token_file_test
