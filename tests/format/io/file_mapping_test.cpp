#include "format/io/file_mapping.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "tests/support/message_of_error.h"
#include "tests/support/temporary_directory.h"

namespace weir::file_mapping_test {
namespace {

template <class Call>
std::string refusal_of(Call call) {
  return message_of_error(ErrorKind::input, [&] { call(); });
}

std::string refusal(const std::string& path) {
  return refusal_of([&] { const FileMapping mapping(path, ".nvdb"); });
}

TEST(FileMapping, BytesOutliveMovesAndReleasedPages) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "a") << "bytes";
  FileMapping first(directory / "a", ".nvdb");
  const FileMapping mapping(std::move(first));
  const std::byte* const at = mapping.bytes().data();
  ASSERT_EQ(mapping.bytes().size(), 5U);
  EXPECT_EQ(mapping.bytes()[4], std::byte{'s'});
  mapping.release_pages();
  EXPECT_EQ(mapping.bytes().data(), at);
  EXPECT_EQ(mapping.bytes()[0], std::byte{'b'});
}

TEST(FileMapping, RefusesMissingEmptyAndNonRegularFiles) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "empty").close();
  EXPECT_EQ(refusal(directory / "none"), directory / "none" + ": cannot open: No such file or directory");
  EXPECT_EQ(refusal(directory / "empty"), directory / "empty" + ": the file is empty; give a .nvdb file");
  EXPECT_EQ(refusal(directory.path().string()), directory.path().string() + ": not a regular file; give a .nvdb file");
}

// The right to read may come back, and says nothing of what the file holds.
TEST(FileMapping, FileWithoutReadPermission_IsAnIoError) {
  const TemporaryDirectory directory;
  const std::string path = directory / "locked";
  std::ofstream(path) << "bytes";
  ASSERT_EQ(::chmod(path.c_str(), 0), 0);
  const uid_t self = ::geteuid();
  ASSERT_EQ(::seteuid(self == 0 ? 65534 : self), 0);  // root may read everything
  EXPECT_EQ(
      message_of_error(ErrorKind::io, [&] { const FileMapping mapping(path, ".nvdb"); }),
      path + ": cannot open: Permission denied; give this user the right to read it and to enter its directories");
  ASSERT_EQ(::seteuid(self), 0);
}

TEST(FileMapping, FileThatCannotBeMapped_IsAnIoError) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a";
  std::ofstream(path) << "bytes";
  Descriptor write_only(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  const std::string message =
      message_of_error(ErrorKind::io, [&] { const FileMapping mapping(std::move(write_only), path, ".nvdb"); });
  EXPECT_TRUE(message.starts_with(path + ": cannot map: Permission denied")) << message;
}

TEST(FileMapping, ErrorsOfTheName_AreInputErrors) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "file") << "bytes";
  EXPECT_EQ(refusal(directory / "file/a"),
            directory / "file/a" + ": cannot open: Not a directory; correct the path, a part of which is a file");
  const std::string longer = directory / std::string(300, 'x');
  EXPECT_EQ(refusal(longer), longer + ": cannot open: File name too long; choose a shorter name");
  std::filesystem::create_symlink("loop", directory / "loop");
  EXPECT_EQ(refusal(directory / "loop"), directory / "loop" +
                                             ": cannot open: Too many levels of symbolic links; correct the symbolic "
                                             "links of its path, which lead in a circle");
}

TEST(FileMapping, ReadsAndPopulatesAnyRange) {
  const TemporaryDirectory directory;
  constexpr std::uint64_t kBytes = 70001;
  std::string text;
  for (std::uint64_t i = 0; i < kBytes; ++i) text.push_back(static_cast<char>(i * i % 251));
  std::ofstream(directory / "a", std::ios::binary) << text;
  const FileMapping mapping(directory / "a", ".nvdb");
  EXPECT_EQ(mapping.path(), directory / "a");
  mapping.prefetch(0, kBytes);
  mapping.populate(0, kBytes);
  mapping.populate(4097, kBytes - 4097);
  EXPECT_TRUE(mapping.cached(0, kBytes));
  EXPECT_TRUE(mapping.cached(kBytes - 1, 1));
  std::vector<std::byte> part(60000);
  mapping.read(10001, part);
  EXPECT_TRUE(std::equal(part.begin(), part.end(), mapping.bytes().begin() + 10001));
  EXPECT_EQ(refusal_of([&] { mapping.read(10002, part); }),
            directory / "a" + ": ends at byte 70001, before what was asked for");
  mapping.check_unchanged();
}

TEST(FileMapping, ReportsATruncatedFileWithoutASignal) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "a") << std::string(40000, 'x');
  const FileMapping mapping(directory / "a", ".nvdb");
  std::filesystem::resize_file(directory / "a", 5000);
  const std::string message =
      directory / "a" + ": had 40000 bytes when it was opened, has 5000 now; open it again when it is whole";
  EXPECT_EQ(refusal_of([&] { mapping.populate(0, 40000); }), message);
  EXPECT_EQ(refusal_of([&] { mapping.check_unchanged(); }), message);
  std::vector<std::byte> part(40000);
  EXPECT_EQ(refusal_of([&] { mapping.read(0, part); }), message);
  mapping.populate(0, 5000);
}

TEST(FileMapping, TellsARewrittenFileOfTheSameSize) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "a") << "bytes";
  const FileMapping mapping(directory / "a", ".nvdb");
  std::filesystem::last_write_time(directory / "a",
                                   std::filesystem::last_write_time(directory / "a") + std::chrono::nanoseconds(1));
  EXPECT_EQ(refusal_of([&] { mapping.check_unchanged(); }),
            directory / "a" + ": was written to since it was opened; open it again when it is whole");
}

}  // namespace
}  // namespace weir::file_mapping_test
