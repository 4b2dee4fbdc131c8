// What errors of the real file system say, and which path they carry for programs.
#include <gtest/gtest.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>

#include "format/base/error.h"
#include "format/io/file_system.h"
#include "tests/support/scoped_mount.h"
#include "tests/support/temporary_directory.h"

namespace weir::posix_file_system_test {
namespace {

// An offset and a size that no file has: the system refuses them as negative.
constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();

Error error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error;
  }
  return {ErrorKind::internal, "no error"};
}

TEST(PosixFileSystem, FileThatIsRemovedOrReplaced_HasNotItsNameAnyMore) {
  const TemporaryDirectory directory;
  const auto files = make_posix_file_system();
  const auto file = files->create(directory / "a");
  EXPECT_TRUE(file->has_its_name());
  files->rename(directory / "a", directory / "b");
  EXPECT_FALSE(file->has_its_name()) << "missing";
  const auto other = files->create(directory / "a");
  EXPECT_FALSE(file->has_its_name()) << "another file";
  EXPECT_TRUE(other->has_its_name());
  files->rename(directory / "b", directory / "a");
  EXPECT_TRUE(file->has_its_name()) << "it is back";
}

// Whoever asks for the room there needs a directory that exists, and people need to know which file it was.
TEST(PosixFileSystem, FileWithoutAName_FailsWithItsDirectoryAsThePath) {
  const TemporaryDirectory directory;
  const std::string place = directory.path().string();
  const auto file = make_posix_file_system()->create_unnamed(place);
  EXPECT_EQ(file->path(), place + " (temporary file)");
  std::array<std::byte, 3> bytes{};
  const std::array<Error, 3> errors{error_of([&] { file->write_at(kNone, bytes); }),
                                    error_of([&] { file->read_at(kNone, bytes); }),
                                    error_of([&] { file->preallocate(kNone); })};
  const std::array<std::string, 3> actions{"write 3 bytes at offset 18446744073709551615",
                                           "read 3 bytes at offset 18446744073709551615",
                                           "reserve 18446744073709551615 bytes"};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    EXPECT_EQ(errors[i].kind(), ErrorKind::io);
    EXPECT_EQ(errors[i].what(), place + " (temporary file): cannot " + actions[i] + ": Invalid argument");
    ASSERT_TRUE(errors[i].system_failure()) << actions[i];
    EXPECT_EQ(errors[i].system_failure()->errno_value, EINVAL);
    EXPECT_EQ(errors[i].system_failure()->path, place);
  }
}

TEST(PosixFileSystem, FileWithAName_FailsWithItAsThePath) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a";
  const auto file = make_posix_file_system()->create(path);
  const Error error = error_of([&] { file->preallocate(kNone); });
  EXPECT_EQ(error.what(), path + ": cannot reserve 18446744073709551615 bytes: Invalid argument");
  ASSERT_TRUE(error.system_failure());
  EXPECT_EQ(error.system_failure()->path, path);
}

TEST(PosixFileSystem, DirectoryThatIsACircleOfLinks_IsAnIoErrorOfThePath) {
  const TemporaryDirectory directory;
  std::filesystem::create_symlink("loop2", directory / "loop1");
  std::filesystem::create_symlink("loop1", directory / "loop2");
  const Error error = error_of([&] { make_posix_file_system()->create(directory / "loop1/a"); });
  EXPECT_EQ(error.kind(), ErrorKind::io);
  EXPECT_EQ(error.what(), directory / "loop1/a" +
                              ": cannot create: Too many levels of symbolic links; correct the symbolic links of its "
                              "path, which lead in a circle");
  ASSERT_TRUE(error.system_failure());
  EXPECT_EQ(error.system_failure()->errno_value, ELOOP);
}

TEST(PosixFileSystem, DirectoryThatTakesNoFiles_IsSaidWithARemedy) {
  const TemporaryDirectory directory;
  const auto files = make_posix_file_system();
  std::ofstream(directory / "file") << "bytes";
  EXPECT_EQ(error_of([&] { files->create(directory / "file/a"); }).what(),
            directory / "file/a" + ": cannot create: Not a directory; correct the path, a part of which is a file");
  const std::string remedy = "; its directory is gone or takes no files, choose another place";
  const std::string missing = directory / "none/a";
  const std::array<Error, 3> errors{error_of([&] { files->create(missing); }),
                                    error_of([&] { files->make_directory(missing); }),
                                    error_of([&] { files->create_unnamed(missing); })};
  const std::array<std::string, 3> actions{"create", "create the directory", "create a temporary file in it"};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    EXPECT_EQ(errors[i].what(), missing + ": cannot " + actions[i] + ": No such file or directory" + remedy);
    ASSERT_TRUE(errors[i].system_failure()) << actions[i];
    EXPECT_EQ(errors[i].system_failure()->errno_value, ENOENT);
  }
}

TEST(PosixFileSystem, FullDisk_FileWithoutAName_FailsWithItsDirectoryAsThePath) {
  const TemporaryDirectory directory;
  const std::string place = directory.path().string();
  const ScopedMount mount(place, 1 << 20);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  const auto file = make_posix_file_system()->create_unnamed(place);
  const Error error = error_of([&] { file->preallocate(2 << 20); });
  EXPECT_EQ(error.what(), place +
                              " (temporary file): cannot reserve 2097152 bytes: No space left on device; free space on "
                              "that file system or choose another with -o or --work-dir");
  ASSERT_TRUE(error.system_failure());
  EXPECT_EQ(error.system_failure()->errno_value, ENOSPC);
  EXPECT_EQ(error.system_failure()->path, place);
}

}  // namespace
}  // namespace weir::posix_file_system_test
