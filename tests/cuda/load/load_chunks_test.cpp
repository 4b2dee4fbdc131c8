#include "gpu/cuda/load/load_chunks.h"

#include <gtest/gtest.h>

namespace weir::load_chunks_test {
namespace {

constexpr std::uint64_t kPage = 4096;

TEST(LoadChunks, GrowToTheirSizeAndShareNoPage) {
  const auto chunks = plan_load_chunks(kPage, 30 * kPage, kPage, 8 * kPage);
  const std::vector<LoadChunk> expected{
      {1 * kPage, 2 * kPage, 1 * kPage, 2 * kPage},     {2 * kPage, 4 * kPage, 2 * kPage, 4 * kPage},
      {4 * kPage, 8 * kPage, 4 * kPage, 8 * kPage},     {8 * kPage, 16 * kPage, 8 * kPage, 16 * kPage},
      {16 * kPage, 24 * kPage, 16 * kPage, 24 * kPage}, {24 * kPage, 31 * kPage, 24 * kPage, 31 * kPage},
  };
  EXPECT_EQ(chunks, expected);
}

TEST(LoadChunks, CopyFromAndToTheMiddleOfPages) {
  const auto chunks = plan_load_chunks(5000, 8000, kPage, kPage);
  const std::vector<LoadChunk> expected{
      {4096, 8192, 5000, 8192}, {8192, 12288, 8192, 12288}, {12288, 16384, 12288, 13000}};
  EXPECT_EQ(chunks, expected);
}

TEST(LoadChunks, AreWholePagesWhateverTheSizeAskedFor) {
  EXPECT_EQ(plan_load_chunks(0, 1, kPage, 1), (std::vector<LoadChunk>{{0, kPage, 0, 1}}));
  EXPECT_EQ(plan_load_chunks(0, 3 * kPage, kPage, kPage + 1),
            (std::vector<LoadChunk>{{0, kPage, 0, kPage}, {kPage, 3 * kPage, kPage, 3 * kPage}}));
  EXPECT_TRUE(plan_load_chunks(5000, 0, kPage, kPage).empty());
}

TEST(LoadChunks, CoverEveryByteOnceForAnyRange) {
  for (std::uint64_t offset = 0; offset < 3 * kPage; offset += 517) {
    for (std::uint64_t bytes = 1; bytes < 70 * kPage; bytes = bytes * 2 + 13) {
      for (const std::uint64_t chunk_bytes : {std::uint64_t{1}, kPage, 3 * kPage, 16 * kPage, 1000 * kPage}) {
        std::uint64_t page = offset / kPage * kPage;
        std::uint64_t byte = offset;
        for (const LoadChunk& chunk : plan_load_chunks(offset, bytes, kPage, chunk_bytes)) {
          ASSERT_EQ(chunk.begin, page);
          ASSERT_EQ(chunk.copy_begin, byte);
          ASSERT_EQ(chunk.end % kPage, 0U);
          ASSERT_LT(chunk.copy_begin, chunk.copy_end);
          ASSERT_LE(chunk.copy_end, chunk.end);
          page = chunk.end;
          byte = chunk.copy_end;
        }
        ASSERT_EQ(byte, offset + bytes);
        ASSERT_LT(page - byte, kPage);
      }
    }
  }
}

}  // namespace
}  // namespace weir::load_chunks_test
