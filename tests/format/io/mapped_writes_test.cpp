#include "format/io/mapped_writes.h"

#include <gtest/gtest.h>

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

TEST(MappedWrites, AreNotOfAFileWithoutADescriptor) {
  MemoryFileSystem files;
  const auto file = files.create("a");
  file->preallocate(100);
  EXPECT_EQ(MappedWrites::of(*file, 100), nullptr);
}

}  // namespace
}  // namespace weir::mapped_writes_test
