// Tests reads of an input file in every mode, and that they leave the page cache as it was.
#include "ingest/files/input_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "format/io/descriptor.h"
#include "ingest/plan/page_buffer.h"
#include "tests/ingest/support/scratch.h"

namespace weir::input_file_test {
namespace {

constexpr std::size_t kPage = 4096;

std::vector<std::byte> pattern(std::size_t bytes) {
  std::vector<std::byte> result(bytes);
  for (std::size_t i = 0; i < bytes; ++i) result[i] = static_cast<std::byte>((i * 2654435761U) >> 13U);
  return result;
}

/// Writes the file's dirty pages to the disk and drops all its pages from the page cache.
void drop_from_cache(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  ASSERT_EQ(::fsync(file.get()), 0);
  ASSERT_EQ(::posix_fadvise(file.get(), 0, 0, POSIX_FADV_DONTNEED), 0);
}

/// Returns for each page of the file whether it is in the page cache.
std::vector<bool> cached_pages(const std::string& path, std::size_t bytes) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  void* map = ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, file.get(), 0);
  std::vector<unsigned char> flags((bytes + kPage - 1) / kPage);
  EXPECT_EQ(::mincore(map, bytes, flags.data()), 0);
  ::munmap(map, bytes);
  std::vector<bool> result;
  result.reserve(flags.size());
  for (const unsigned char f : flags) result.push_back((f & 1U) != 0);
  return result;
}

std::size_t count_cached(const std::string& path, std::size_t bytes) {
  std::size_t n = 0;
  for (const bool cached : cached_pages(path, bytes)) n += cached ? 1 : 0;
  return n;
}

std::string open_refusal(const std::string& path, ErrorKind kind = ErrorKind::input,
                         DirectIo mode = DirectIo::automatic) {
  return message_of_error(kind, [&] { InputFile(path, mode); });
}

TEST(InputFile, RefusesMissingEmptyAndNonRegularFiles) {
  const Scratch scratch;
  EXPECT_EQ(open_refusal(scratch.path("none.raw")),
            scratch.path("none.raw") + ": cannot open for reading: No such file or directory");
  EXPECT_EQ(open_refusal(scratch.path("")), scratch.path("") + ": is a directory; name a file in it");
  EXPECT_EQ(open_refusal(scratch.write("empty.raw", {})),
            scratch.path("empty.raw") + ": is empty (0 bytes); copy it again, or write it anew");
  ASSERT_EQ(::mkfifo(scratch.path("pipe.raw").c_str(), 0600), 0);
  EXPECT_EQ(open_refusal(scratch.path("pipe.raw")),
            scratch.path("pipe.raw") + ": is not a regular file; copy its content to one");
}

TEST(InputFile, RefusesFilesWithoutReadPermission) {
  const Scratch scratch;
  const std::string path = scratch.write("locked.raw", pattern(100));
  ASSERT_EQ(::chmod(path.c_str(), 0), 0);
  const uid_t self = ::geteuid();
  ASSERT_EQ(::seteuid(self == 0 ? 65534 : self), 0);  // because root may read every file
  EXPECT_EQ(open_refusal(path, ErrorKind::io), path +
                                                   ": cannot open for reading: Permission denied; give this user the "
                                                   "right to read it and to enter its directories");
  ASSERT_EQ(::seteuid(self), 0);
}

class InputFileModes : public ::testing::TestWithParam<DirectIo> {};

TEST_P(InputFileModes, ReadsAnyRange) {
  const Scratch scratch;
  const auto bytes = pattern(3 * kPage + 1234);
  const std::string path = scratch.write("a.bin", bytes);
  InputFile file(path, GetParam());
  EXPECT_EQ(file.size(), bytes.size());
  EXPECT_GT(file.mtime_ns(), 1'600'000'000'000'000'000);
  const PageBuffer staging(bytes.size() + 2 * kDirectAlignment);
  for (const std::size_t offset :
       {std::size_t{0}, std::size_t{1}, kPage - 1, kPage, 2 * kPage + 77, bytes.size() - 1}) {
    for (const std::size_t count : {std::size_t{1}, std::size_t{7}, kPage, 2 * kPage + 1, bytes.size()}) {
      if (offset + count > bytes.size()) continue;
      const auto direct = file.read_direct(offset, count, staging.bytes());
      ASSERT_EQ(direct.size(), count);
      EXPECT_EQ(std::memcmp(direct.data(), bytes.data() + offset, count), 0) << offset << ' ' << count;
      std::vector<std::byte> buffered(count);
      file.read_buffered(offset, buffered, ReadPath::through);
      EXPECT_EQ(std::memcmp(buffered.data(), bytes.data() + offset, count), 0) << offset << ' ' << count;
      file.read_buffered(offset, buffered, ReadPath::cache);
      EXPECT_EQ(std::memcmp(buffered.data(), bytes.data() + offset, count), 0) << offset << ' ' << count;
    }
  }
  EXPECT_GT(file.bytes_read(), 0U);
}

TEST_P(InputFileModes, AFileCutWhileOpenIsNamedWithItsEnd) {
  const Scratch scratch;
  const std::string path = scratch.write("cut.bin", pattern(3 * kPage));
  InputFile file(path, GetParam());
  std::filesystem::resize_file(path, kPage + 10);
  const PageBuffer staging(5 * kPage);
  const std::string message = path + ": the file ended at offset 4106 while reading 8000 bytes at offset 100; it had " +
                              "12288 bytes when it was opened: it was cut while being read";
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { file.read_direct(100, 8000, staging.bytes()); }), message);
  std::vector<std::byte> into(8000);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { file.read_buffered(100, into, ReadPath::through); }), message);
  EXPECT_EQ(file.read_direct(100, 4006, staging.bytes()).size(), 4006U);  // the bytes before the new end are read
}

INSTANTIATE_TEST_SUITE_P(All, InputFileModes, ::testing::Values(DirectIo::automatic, DirectIo::on, DirectIo::off));

class InputFileCache : public ::testing::Test {
 protected:
  static constexpr std::size_t kBytes = 700 * kPage + 5;

  /// Writes a file of kBytes and drops its pages from the page cache. Skips the test if pages stay in the cache.
  void SetUp() override {
    path_ = scratch_.write("cache.bin", pattern(kBytes));
    drop_from_cache(path_);
    if (count_cached(path_, kBytes) > 0) GTEST_SKIP() << "skipped: the page cache keeps files of " << path_;
  }
  void touch(std::size_t first_page, std::size_t pages) {
    const Descriptor file(::open(path_.c_str(), O_RDONLY | O_CLOEXEC));
    ::posix_fadvise(file.get(), 0, 0, POSIX_FADV_RANDOM);
    std::vector<std::byte> bytes(pages * kPage);
    ASSERT_GT(::pread(file.get(), bytes.data(), bytes.size(), static_cast<off_t>(first_page * kPage)), 0);
  }

  Scratch scratch_;
  std::string path_;
};

TEST_F(InputFileCache, AutomaticReadsCachedPagesThroughTheCache) {
  const InputFile file(path_, DirectIo::automatic);
  if (file.path_for(0, kBytes) != ReadPath::direct) GTEST_SKIP() << "skipped: no direct I/O at " << path_;
  touch(100, 50);
  ASSERT_EQ(count_cached(path_, kBytes), 50U);
  EXPECT_EQ(file.path_for(100 * kPage, 50 * kPage), ReadPath::cache);
  EXPECT_EQ(file.path_for(120 * kPage + 5, 100), ReadPath::cache);
  EXPECT_EQ(file.path_for(100 * kPage - 1, 10), ReadPath::direct);
  EXPECT_EQ(file.path_for(149 * kPage, kPage + 1), ReadPath::direct);
  EXPECT_EQ(file.path_for(0, kBytes), ReadPath::direct);
  EXPECT_EQ(count_cached(path_, kBytes), 50U);  // path_for() loads no page
  EXPECT_EQ(InputFile(path_, DirectIo::on).path_for(100 * kPage, kPage), ReadPath::direct);
  EXPECT_EQ(InputFile(path_, DirectIo::off).path_for(0, kBytes), ReadPath::through);
  EXPECT_EQ(InputFile(path_, DirectIo::off).path_for(100 * kPage, kPage), ReadPath::cache);
}

TEST_F(InputFileCache, BufferedReadsLeaveTheCacheAsItWas) {
  InputFile file(path_, DirectIo::off);
  touch(3, 1);
  touch(100, 50);
  touch(699, 2);
  const auto before = cached_pages(path_, kBytes);
  std::vector<std::byte> bytes(kBytes);
  file.read_buffered(0, bytes, ReadPath::through);
  EXPECT_EQ(bytes, pattern(kBytes));
  EXPECT_EQ(cached_pages(path_, kBytes), before);
  // Small unaligned reads leave the cache as it was, too.
  for (std::size_t at = 0; at + 5000 < kBytes; at += 5000) {
    file.read_buffered(at, std::span(bytes).first(5000), ReadPath::through);
  }
  EXPECT_EQ(cached_pages(path_, kBytes), before);
}

TEST_F(InputFileCache, DirectReadsLeaveTheCacheAsItWas) {
  InputFile file(path_, DirectIo::on);
  touch(100, 50);
  const PageBuffer staging(kBytes + 2 * kDirectAlignment);
  const auto bytes = file.read_direct(0, kBytes, staging.bytes());
  EXPECT_EQ(std::memcmp(bytes.data(), pattern(kBytes).data(), kBytes), 0);
  EXPECT_EQ(count_cached(path_, kBytes), 50U);
}

TEST_F(InputFileCache, RefusedDirectReadFallsBackToTheCache) {
  // The kernel refuses a direct read into unaligned memory, as it would for a device that needs a wider alignment.
  const PageBuffer memory(kBytes + 3 * kDirectAlignment);
  const auto staging = memory.bytes().subspan(1, kBytes + 2 * kDirectAlignment);
  InputFile strict(path_, DirectIo::on);
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { strict.read_direct(5, 100, staging); }),
            path_ + ": its file system refuses direct I/O; use --direct-io auto");

  InputFile file(path_, DirectIo::automatic);
  ASSERT_EQ(file.path_for(0, kBytes), ReadPath::direct);
  const auto bytes = file.read_direct(5, 10'000, staging);
  EXPECT_EQ(std::memcmp(bytes.data(), pattern(kBytes).data() + 5, 10'000), 0);
  EXPECT_EQ(file.path_for(0, kBytes), ReadPath::through);  // for all later reads
  EXPECT_EQ(count_cached(path_, kBytes), 0U);
}

TEST(InputFileRefused, FileSystemsWithoutDirectIo) {
  // sysfs has no direct I/O, and its binary attributes are regular files with a true size.
  const std::string path = "/sys/kernel/notes";
  const Descriptor probe(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat status {};
  if (!probe || ::fstat(probe.get(), &status) != 0 || status.st_size == 0) GTEST_SKIP() << "skipped: no " << path;
  EXPECT_EQ(open_refusal(path, ErrorKind::usage, DirectIo::on),
            path + ": its file system refuses direct I/O; use --direct-io auto");
  InputFile file(path, DirectIo::automatic);
  EXPECT_NE(file.path_for(0, file.size()), ReadPath::direct);
  std::vector<std::byte> expected(file.size());
  ASSERT_EQ(::pread(probe.get(), expected.data(), expected.size(), 0), static_cast<ssize_t>(expected.size()));
  const PageBuffer staging(file.size() + 2 * kDirectAlignment);
  const auto bytes = file.read_direct(0, file.size(), staging.bytes());
  EXPECT_EQ(std::memcmp(bytes.data(), expected.data(), expected.size()), 0);
}

}  // namespace
}  // namespace weir::input_file_test
