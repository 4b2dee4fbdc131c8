// Tests that ChunkStore fetches the chunks of a dataset as the file stores them.
#include "ingest/hdf5/storage/chunk_store.h"

#include <zlib.h>

#include <vector>

#include "tests/ingest/hdf5/support/chunked_file.h"
#include "tests/ingest/support/scratch.h"

namespace weir::chunk_store_test {
namespace {

using Corner = std::vector<hsize_t>;

std::vector<std::byte> counted(std::size_t size) {
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(i * 31);
  return bytes;
}

TEST(ChunkStore, FetchesWhatWasStored) {
  const Scratch scratch;
  for (const H5F_libver_t oldest : {H5F_LIBVER_V18, H5F_LIBVER_V110}) {
    ChunkedFile file(scratch.path("f.h5"),
                     {{5, 40, 60}, {2, 16, 16}, {H5Z_FILTER_DEFLATE}, false, H5T_NATIVE_UINT8, oldest});
    file.write_chunk({2, 16, 48}, counted(100), 1);
    file.write_chunk({4, 32, 0}, counted(7));
    file.reopen();
    const ChunkStore store(file.dataset(), "run.h5: d");
    EXPECT_EQ(store.layout().extent, (Corner{5, 40, 60}));
    EXPECT_EQ(store.layout().chunk, (Corner{2, 16, 16}));
    ASSERT_EQ(store.pipeline().size(), 1U);

    std::vector<std::byte> bytes(512);
    auto chunk = store.fetch(Corner{2, 16, 48}, bytes);
    ASSERT_TRUE(chunk);
    EXPECT_EQ(chunk->bytes, 100U);
    EXPECT_EQ(chunk->left_out, 1U);
    bytes.resize(100);
    EXPECT_EQ(bytes, counted(100));
    chunk = store.fetch(Corner{4, 32, 0}, bytes);
    ASSERT_TRUE(chunk);
    EXPECT_EQ(chunk->bytes, 7U);
    EXPECT_EQ(chunk->left_out, 0U);
    EXPECT_FALSE(store.fetch(Corner{0, 0, 0}, bytes));
    EXPECT_FALSE(store.fetch(Corner{4, 32, 48}, bytes));
    EXPECT_EQ(message_of_error(ErrorKind::input,
                               [&] {
                                 store.fetch(Corner{2, 16, 48}, std::span(bytes).first(99));
                               }),
              "run.h5: d: chunk at 2, 16, 48: takes 100 bytes, and at most 99 can be right; the file is damaged");
  }
}

TEST(ChunkStore, OneOfAMillionChunksIsFoundWithoutAListOfAll) {
  const Scratch scratch;
  ChunkedFile file(scratch.path("f.h5"), {{1600, 1600, 1600}, {16, 16, 16}, {H5Z_FILTER_DEFLATE}});
  for (hsize_t i = 0; i < 1600; i += 16) file.write_chunk({i, 0, 1584 - i}, counted(20 + i));
  file.reopen();
  const ChunkStore store(file.dataset(), "run.h5: d");
  std::vector<std::byte> bytes(2048);
  for (hsize_t i = 0; i < 1600; i += 16) {
    EXPECT_EQ(store.fetch(Corner{i, 0, 1584 - i}, bytes).value().bytes, 20 + i);
    EXPECT_FALSE(store.fetch(Corner{i, 16, 1584 - i}, bytes));
  }
}

TEST(ChunkStore, OverhangingChunksMayHaveGoneThroughNoFilter) {
  const Scratch scratch;
  ChunkedFile file(scratch.path("f.h5"),
                   {{4, 4, 12}, {4, 4, 8}, {H5Z_FILTER_DEFLATE}, true, H5T_NATIVE_UINT8, H5F_LIBVER_V110});
  file.write(H5T_NATIVE_UINT8, std::vector<std::uint8_t>(4 * 4 * 12, 5));
  file.reopen();
  const ChunkStore store(file.dataset(), "run.h5: d");
  std::vector<std::byte> bytes(256);
  EXPECT_EQ(store.fetch(Corner{0, 0, 0}, bytes).value().left_out, 0U);
  const auto edge = store.fetch(Corner{0, 0, 8}, bytes).value();
  EXPECT_EQ(edge.left_out, kAllLeftOut);
  EXPECT_EQ(edge.bytes, 128U);
}

TEST(ChunkStore, CornerTextKeepsTheAxisOrderOfTheFile) {
  EXPECT_EQ(corner_text(Corner{0, 128, 64}), "0, 128, 64");
  EXPECT_EQ(corner_text(Corner{7}), "7");
}

}  // namespace
}  // namespace weir::chunk_store_test
