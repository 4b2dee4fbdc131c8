#include "daemon/config/regular_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "daemon/config/load_config.h"
#include "tests/support/message_of_error.h"
#include "tests/support/temporary_directory.h"

namespace weir::regular_file_test {
namespace {

constexpr const char* kNoFile = ": is no regular file, and weir watch reads it again at each reload; name a file";

TEST(RegularFile, IsReadUpToTheLimit) {
  const TemporaryDirectory directory;
  const std::string path = directory / "file";
  write_file(path, std::string(5000, 'a'));
  require_regular_file(path);
  EXPECT_EQ(read_regular_file(path, 5000), std::string(5000, 'a'));
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { read_regular_file(path, 4999); }),
            path + ": has more than 4999 bytes, no such file needs as many; name another");
}

TEST(RegularFile, PipeWithoutAWriter_IsRefusedAtOnce) {
  const TemporaryDirectory directory;
  const std::string pipe = directory / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { read_regular_file(pipe, 10); }), pipe + kNoFile);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { require_regular_file(pipe); }), pipe + kNoFile);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { load_config(pipe); }), pipe + kNoFile);
}

TEST(RegularFile, Device_IsRefused) {
  EXPECT_EQ(message_of_error(ErrorKind::input, [] { load_config("/dev/zero"); }), std::string("/dev/zero") + kNoFile);
}

TEST(RegularFile, MissingFile_IsLeftToItsReader) {
  const TemporaryDirectory directory;
  require_regular_file(directory / "none");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { read_regular_file(directory / "none", 10); }),
            (directory / "none") + ": cannot read: No such file or directory");
}

}  // namespace
}  // namespace weir::regular_file_test
