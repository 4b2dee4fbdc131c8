#include "format/io/reused_pages.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/io/memory_file_system.h"

namespace weir::reused_pages_test {
namespace {

constexpr std::size_t kMebibyte = std::size_t{1} << 20U;

std::span<std::byte> mapping_of(std::size_t bytes) {
  void* const memory =
      ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  EXPECT_NE(memory, MAP_FAILED);
  return {static_cast<std::byte*>(memory), bytes};
}

TEST(ReusedPages, GiveTheSmallestMappingThatIsLargeEnoughAndNotTwiceTooLarge) {
  ReusedPages pages;
  EXPECT_TRUE(pages.take(20 * kMebibyte).empty());
  const std::span<std::byte> small = mapping_of(24 * kMebibyte);
  const std::span<std::byte> large = mapping_of(64 * kMebibyte);
  pages.give_back(large);
  pages.give_back(small);
  EXPECT_EQ(pages.held_bytes(), 88 * kMebibyte);
  EXPECT_TRUE(pages.take(65 * kMebibyte).empty());
  EXPECT_TRUE(pages.take(1).empty());
  const std::span<std::byte> taken = pages.take(20 * kMebibyte);
  EXPECT_EQ(taken.data(), small.data());
  EXPECT_EQ(taken.size(), small.size());
  EXPECT_TRUE(pages.take(20 * kMebibyte).empty()) << "64 MiB is more than twice as much";
  EXPECT_EQ(pages.take(40 * kMebibyte).data(), large.data());
  EXPECT_EQ(pages.held_bytes(), 0U);
  taken.back() = std::byte{1};  // may be written to
  pages.give_back(taken);
  pages.give_back(large);
}

TEST(ReusedPages, HoldNoSmallMappings_AndUnmapTheOldestWhereTheyWouldHoldTooMuch) {
  ReusedPages pages;
  pages.give_back(mapping_of(ReusedPages::kLeast / 2));
  EXPECT_EQ(pages.held_bytes(), 0U);
  pages.give_back(mapping_of(ReusedPages::kMostHeld + kMebibyte));
  EXPECT_EQ(pages.held_bytes(), 0U);
  pages.give_back({});
  const std::span<std::byte> oldest = mapping_of(300 * kMebibyte);
  pages.give_back(oldest);
  pages.give_back(mapping_of(400 * kMebibyte));
  pages.give_back(mapping_of(500 * kMebibyte));
  EXPECT_EQ(pages.held_bytes(), 900 * kMebibyte);
  unsigned char resident = 0;
  EXPECT_EQ(::mincore(oldest.data(), 4096, &resident), -1) << "it is unmapped";
  const std::span<std::byte> taken = pages.take(250 * kMebibyte);
  EXPECT_EQ(taken.size(), 400 * kMebibyte);
  ::munmap(taken.data(), taken.size());
  pages.clear();
  EXPECT_EQ(pages.held_bytes(), 0U);
}

TEST(ReusedPages, AreThoseOfFilesThatAreGone) {
  ReusedPages& pages = ReusedPages::of_process();
  pages.clear();
  MemoryFileSystem files(MemoryFileSystem::PagesOf::earlier_files);
  constexpr std::size_t kBytes = 20 * kMebibyte;
  const std::vector<std::byte> data(kBytes, std::byte{7});
  const std::byte* before = nullptr;
  {
    const auto file = files.create_unnamed(".");
    file->preallocate(kBytes);
    file->write_at(0, data);
    before = file->memory().data();
  }
  EXPECT_GE(pages.held_bytes(), kBytes);
  {
    const auto file = files.create_unnamed(".");
    file->preallocate(kBytes - 5);
    EXPECT_EQ(pages.held_bytes(), 0U);
    EXPECT_EQ(file->memory().data(), before);
    EXPECT_EQ(file->size(), kBytes - 5) << "as asked for, whatever the mapping has";
    file->write_at(0, data);  // grows
    EXPECT_EQ(file->size(), kBytes);
    EXPECT_EQ(file->memory().back(), std::byte{7});
  }
  MemoryFileSystem fresh;
  const auto file = fresh.create_unnamed(".");
  file->preallocate(kBytes);
  EXPECT_EQ(file->memory()[kBytes / 2], std::byte{0}) << "of the system's pages";
  EXPECT_GE(pages.held_bytes(), kBytes);
  pages.clear();
}

}  // namespace
}  // namespace weir::reused_pages_test
