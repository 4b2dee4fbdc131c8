#include "format/io/memory_file_system.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <string_view>
#include <thread>
#include <vector>

#include "format/base/error.h"
#include "format/output/output_files.h"

namespace weir::memory_file_system_test {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }
std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

template <typename Action>
std::string io_message(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::io) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

TEST(MemoryFileSystem, ReadsBackWrittenBytesAndZerosInGaps) {
  MemoryFileSystem files;
  const auto file = files.create("a");
  EXPECT_EQ(file->size(), 0U);
  file->write_at(3, bytes_of("abc"));
  file->write_at(1, {});
  EXPECT_EQ(file->size(), 6U);
  EXPECT_EQ(text_of(files.content("a")), std::string_view("\0\0\0abc", 6));
  std::array<std::byte, 2> two{};
  file->read_at(4, two);
  EXPECT_EQ(text_of(two), "bc");
  EXPECT_EQ(io_message([&] { file->read_at(5, two); }), "a: has 6 bytes, asked for 2 at offset 5");
  EXPECT_EQ(io_message([&] { file->read_at(UINT64_MAX, two); }),
            "a: has 6 bytes, asked for 2 at offset 18446744073709551615");
  io_message([&] { file->write_at(UINT64_MAX, bytes_of("a")); });
}

TEST(MemoryFileSystem, ContentIsPageAlignedAndPreallocatedToTheByte) {
  MemoryFileSystem files;
  const auto file = files.create("a");
  EXPECT_TRUE(file->preallocate(100'001));
  EXPECT_EQ(files.content("a").size(), 100'001U);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(files.content("a").data()) % 4096, 0U);
  file->preallocate(10);
  EXPECT_EQ(file->size(), 100'001U) << "never shrinks";
  file->clear();
  EXPECT_EQ(file->size(), 0U);
  EXPECT_TRUE(files.content("a").empty());
}

TEST(MemoryFileSystem, GrowsUnderManyWriters) {
  MemoryFileSystem files;
  const auto file = files.create_unnamed("anywhere");
  constexpr std::size_t kWriters = 4;
  constexpr std::size_t kPieces = 500;
  constexpr std::size_t kPieceWords = 1024;
  std::vector<std::jthread> writers;
  for (std::size_t w = 0; w < kWriters; ++w) {
    writers.emplace_back([&, w] {
      std::vector<std::uint64_t> piece(kPieceWords);
      for (std::size_t i = w; i < kWriters * kPieces; i += kWriters) {
        std::iota(piece.begin(), piece.end(), i * kPieceWords);
        file->write_at(i * kPieceWords * 8, std::as_bytes(std::span(piece)));
      }
    });
  }
  writers.clear();
  ASSERT_EQ(file->size(), kWriters * kPieces * kPieceWords * 8);
  std::vector<std::uint64_t> all(kWriters * kPieces * kPieceWords);
  file->read_at(0, std::as_writable_bytes(std::span(all)));
  for (std::size_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i], i);
}

TEST(MemoryFileSystem, Names) {
  MemoryFileSystem files;
  files.create("a")->write_at(0, bytes_of("a"));
  files.create("b")->write_at(0, bytes_of("b"));
  EXPECT_TRUE(files.exists("."));
  EXPECT_TRUE(files.exists("a"));
  EXPECT_FALSE(files.exists("c"));
  EXPECT_EQ(io_message([&] { files.rename_new("a", "b"); }), "a: cannot rename to b: File exists");
  EXPECT_EQ(io_message([&] { files.link("a", "b"); }), "a: cannot link to b: File exists");
  files.link("a", "c");
  files.rename("a", "b");
  EXPECT_FALSE(files.exists("a"));
  EXPECT_EQ(text_of(files.content("b")), "a");
  files.rename_new("b", "a");
  EXPECT_EQ(text_of(files.content("c")), "a");
  files.open("c")->write_at(1, bytes_of("c"));
  EXPECT_EQ(text_of(files.content("a")), "ac") << "two names of one file";
  files.remove("a");
  files.remove("a");
  EXPECT_FALSE(files.exists("a"));
  EXPECT_EQ(io_message([&] { files.content("a"); }), "a: cannot find: No such file or directory");
  EXPECT_EQ(io_message([&] { files.rename("a", "b"); }), "a: cannot find: No such file or directory");
  EXPECT_EQ(files.create("c")->size(), 0U);
}

TEST(MemoryFileSystem, CommitsAnOutputAndDropsAnUncommittedOne) {
  MemoryFileSystem files;
  {
    OutputFiles output(files, "v.nvdb", false);
    output.reserve(4);
    output.volume().write_at(0, bytes_of("grid"));
    output.commit("{}\n");
  }
  EXPECT_EQ(text_of(files.content("v.nvdb")), "grid");
  EXPECT_EQ(text_of(files.content("v.nvdb.json")), "{}\n");
  EXPECT_FALSE(files.exists("v.nvdb.partial"));
  { OutputFiles never(files, "w.nvdb", false); }
  EXPECT_FALSE(files.exists("w.nvdb.partial"));
}

}  // namespace
}  // namespace weir::memory_file_system_test
