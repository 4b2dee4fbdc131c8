#include "format/io/parallel_writes.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/magic.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <latch>
#include <string>
#include <thread>
#include <vector>

#include "format/base/process_memory.h"
#include "format/io/descriptor.h"

namespace weir::parallel_writes_test {
namespace {

constexpr std::size_t kBytes = (std::size_t{64} << 20U) + 5;

std::byte byte_at(std::size_t offset) { return static_cast<std::byte>((offset * 2654435761U) >> 13U); }

class ParallelWritesInMemory : public testing::Test {
 protected:
  void SetUp() override {
    struct statfs status {};
    if (::statfs("/dev/shm", &status) != 0 || status.f_type != TMPFS_MAGIC) GTEST_SKIP() << "skipped: no /dev/shm";
    file_.reset(::open("/dev/shm", O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
    ASSERT_TRUE(file_);
    ASSERT_EQ(::fallocate(file_.get(), 0, 0, kBytes), 0);
  }
  void write_all(std::uint64_t offset, std::span<const std::byte> bytes) {
    ASSERT_EQ(::pwrite(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset)),
              static_cast<ssize_t>(bytes.size()));
    ++written_;
  }

  Descriptor file_;
  std::atomic<int> written_{0};  // by the kernel
};

TEST_F(ParallelWritesInMemory, KeepAllBytesAndLittleOfTheProcess) {
  constexpr std::size_t kThreads = 8;
  constexpr std::size_t kPiece = 300'001;  // ends within pages
  std::vector<std::byte> pattern(kBytes);
  for (std::size_t i = 0; i < kBytes; ++i) pattern[i] = byte_at(i);
  const std::uint64_t before = resident_bytes();
  ParallelWrites writes;
  writes.begin(file_.get(), kBytes);
  std::vector<std::jthread> threads;
  for (std::size_t t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      for (std::size_t at = t * kPiece; at < kBytes; at += kThreads * kPiece) {
        const auto piece = std::span(pattern).subspan(at, std::min(kPiece, kBytes - at));
        writes.write(at, piece, [&] { write_all(at, piece); });
      }
    });
  }
  threads.clear();
  EXPECT_LT(resident_bytes(), before + (std::uint64_t{24} << 20U));
  std::vector<std::byte> read(kBytes);
  ASSERT_EQ(::pread(file_.get(), read.data(), kBytes, 0), static_cast<ssize_t>(kBytes));
  EXPECT_TRUE(read == pattern);
}

TEST_F(ParallelWritesInMemory, CopyWhileAnotherThreadWrites) {
  ParallelWrites writes;
  writes.begin(file_.get(), kBytes);
  const std::vector<std::byte> bytes(5000, std::byte{7});
  std::latch writing(1);
  std::latch copied(1);
  std::jthread other([&] {
    writes.write(0, bytes, [&] {
      writing.count_down();
      copied.wait();
      write_all(0, bytes);
    });
  });
  writing.wait();
  writes.write(10'000, bytes, [&] { write_all(10'000, bytes); });
  EXPECT_EQ(written_, 0);
  writes.write(kBytes - 100, bytes, [&] { write_all(kBytes - 100, bytes); });  // beyond the mapping
  EXPECT_EQ(written_, 1);
  copied.count_down();
  other.join();
  EXPECT_EQ(written_, 2);
  std::vector<std::byte> read(5000);
  ASSERT_EQ(::pread(file_.get(), read.data(), read.size(), 10'000), 5000);
  EXPECT_TRUE(read == bytes);
}

TEST(ParallelWritesOnDisk, AreAllTheKernels) {
  const std::string directory = testing::TempDir();
  struct statfs status {};
  if (::statfs(directory.c_str(), &status) != 0 || status.f_type == TMPFS_MAGIC) {
    GTEST_SKIP() << "skipped: " << directory << " is in memory";
  }
  const Descriptor file(::open(directory.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
  if (!file || ::fallocate(file.get(), 0, 0, kBytes) != 0) GTEST_SKIP() << "skipped: no unnamed file in " << directory;
  ParallelWrites writes;
  writes.begin(file.get(), kBytes);
  const std::vector<std::byte> bytes(100);
  int outer = 0;
  int inner = 0;
  writes.write(0, bytes, [&] {
    ++outer;
    writes.write(1000, bytes, [&] { ++inner; });
  });
  EXPECT_EQ(outer, 1);
  EXPECT_EQ(inner, 1);
}

}  // namespace
}  // namespace weir::parallel_writes_test
