#include "daemon/watch/file_writers.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "format/io/descriptor.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::file_writers_test {
namespace {

TEST(FileWritersTest, WriterThatComesMeanwhile_WaitsAndIsToldOf) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a.raw";
  write_file(path, "values");
  std::optional<FileWriters> writers(std::in_place, path);
  ASSERT_FALSE(writers->some());
  EXPECT_FALSE(writers->one_waits());
  std::thread writer([&] {
    const Descriptor file(::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
    EXPECT_EQ(::write(file.get(), "more", 4), 4);
  });
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!writers->one_waits() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
  EXPECT_TRUE(writers->one_waits());
  EXPECT_EQ(read_file(path), "values");
  writers.reset();
  writer.join();
  EXPECT_EQ(read_file(path), "valuesmore");
}

// Tests the search of the processes, used if no lease is available.
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
  EXPECT_FALSE(FileWriters(path).one_waits());
  ASSERT_EQ(::seteuid(0), 0);
  Descriptor writer(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  EXPECT_TRUE(FileWriters(path).some());
}

}  // namespace
}  // namespace weir::file_writers_test
