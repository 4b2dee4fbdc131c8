#include "daemon/watch/file_writers.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>

#include "format/io/descriptor.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::file_writers_test {
namespace {

// The other way to find them, where no lease is to be had.
TEST(FileWritersTest, AnotherUsersFile_IsLookedUpAmongTheProcesses) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a.raw";
  write_file(path, "values");
  if (::geteuid() != 0) GTEST_SKIP() << "only root has other users' files";
  ASSERT_EQ(::chmod(directory.path().c_str(), 0755), 0);
  ASSERT_EQ(::chmod(path.c_str(), 0666), 0);
  ASSERT_EQ(::seteuid(65534), 0);
  EXPECT_FALSE(FileWriters(path).some());
  EXPECT_FALSE(FileWriters(path).known());
  ASSERT_EQ(::seteuid(0), 0);
  Descriptor writer(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  EXPECT_TRUE(FileWriters(path).some());
}

}  // namespace
}  // namespace weir::file_writers_test
