#include "daemon/config/token_file.h"

#include <gtest/gtest.h>

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
