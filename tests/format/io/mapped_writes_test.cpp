#include "format/io/mapped_writes.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <thread>
#include <vector>

#include "format/io/memory_file_system.h"
#include "tests/support/temporary_directory.h"

namespace weir::mapped_writes_test {
namespace {

std::vector<std::byte> bytes_of(std::size_t count, int first) {
  std::vector<std::byte> bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::byte>(first + static_cast<int>(i % 251));
  return bytes;
}

TEST(MappedWrites, AreTheFilesBytes_WhatLiesBehindTheMappingToo) {
  const TemporaryDirectory directory;
  const auto files = make_posix_file_system();
  const auto file = files->create(directory / "a");
  constexpr std::uint64_t kMapped = 100'000;
  file->preallocate(kMapped);
  const auto mapped = MappedWrites::of(*file, kMapped);
  ASSERT_NE(mapped, nullptr);
  EXPECT_EQ(mapped->path(), directory / "a");
  const std::vector<std::byte> all = bytes_of(kMapped + 500, 3);
  std::vector<std::jthread> threads;
  for (std::size_t first = 0; first < 4; ++first) {
    threads.emplace_back([&, first] {
      for (std::size_t at = 999 * first; at < all.size(); at += 4 * 999) {
        mapped->write_at(at, std::span(all).subspan(at, std::min<std::size_t>(999, all.size() - at)));
      }
    });
  }
  threads.clear();
  EXPECT_EQ(mapped->size(), all.size());
  std::vector<std::byte> found(all.size());
  file->read_at(0, found);
  EXPECT_EQ(found == all, true);
  EXPECT_EQ(mapped->memory().size(), kMapped);
  EXPECT_EQ(std::ranges::equal(mapped->memory(), std::span(all).first(kMapped)), true);
}

long page_faults() {
  rusage usage{};
  ::getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt;
}

TEST(MappedWrites, PagesThatAreClearedAreMappedManyAtATime) {
  const auto files = make_posix_file_system();
  if (!files->exists("/dev/shm") || !files->is_memory("/dev/shm")) GTEST_SKIP() << "/dev/shm is no memory file system";
  const auto file = files->create_unnamed("/dev/shm");
  constexpr std::uint64_t kBytes = std::uint64_t{8} << 20U;
  const std::vector<std::byte> all = bytes_of(kBytes, 5);
  const auto faults_of_writing = [&](bool cleared) {
    file->clear();
    file->preallocate(kBytes);
    if (cleared) clear_reserved_pages(*file, kBytes, false);
    const auto mapped = MappedWrites::of(*file, kBytes);
    const long before = page_faults();
    constexpr std::size_t kPiece = 70'000;
    for (std::size_t at = 0; at < all.size(); at += kPiece) {
      mapped->write_at(at, std::span(all).subspan(at, std::min(kPiece, all.size() - at)));
    }
    const long faults = page_faults() - before;
    EXPECT_EQ(std::ranges::equal(mapped->memory(), all), true);
    return faults;
  };
  const long one_by_one = faults_of_writing(false);
  if (one_by_one < static_cast<long>(kBytes / 4096)) GTEST_SKIP() << "its pages are large";
  EXPECT_LT(faults_of_writing(true), one_by_one / 4);
}

TEST(MappedWrites, AreNotOfAFileWithoutADescriptor) {
  MemoryFileSystem files;
  const auto file = files.create("a");
  file->preallocate(100);
  EXPECT_EQ(MappedWrites::of(*file, 100), nullptr);
}

}  // namespace
}  // namespace weir::mapped_writes_test
