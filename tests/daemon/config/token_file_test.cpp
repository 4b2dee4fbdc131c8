#include "daemon/config/token_file.h"

#include <gtest/gtest.h>

#include "tests/support/message_of_error.h"
#include "tests/support/temporary_directory.h"

namespace weir::token_file_test {
namespace {

TEST(TokenFile, Directory_IsRefused) {
  const TemporaryDirectory directory;
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { read_token_file(directory.path()); }),
            directory.path().string() + ": is a directory; name a file with the token");
}

}  // namespace
}  // namespace weir::token_file_test
