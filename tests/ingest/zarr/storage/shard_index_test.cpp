// Tests the places that the index of a shard gives for its chunks.
#include "ingest/zarr/storage/shard_index.h"

#include <gtest/gtest.h>

#include "tests/support/message_of_error.h"

namespace weir::shard_index_test {
namespace {

/// Returns the error message for an index with the one `place`. The shard has 36 bytes: 20 of chunks, 16 of the index.
std::string refusal(bool index_first, const ShardPlace& place) {
  ZarrSharding sharding;
  sharding.index_first = index_first;
  std::vector<std::uint64_t> index{place.offset, place.bytes};
  return message_of_error(ErrorKind::input,
                          [&] { parse_shard_index(sharding, std::as_writable_bytes(std::span(index)), 36, "s"); });
}

TEST(ShardIndex, ChunkThatReachesIntoTheIndex_IsRefused) {
  EXPECT_EQ(refusal(false, {18, 3}),
            "s: chunk 0 of the shard is said to have 3 bytes at 18, and the shard's index lies from 20 to 36; the file "
            "is damaged");
  EXPECT_EQ(refusal(true, {15, 2}),
            "s: chunk 0 of the shard is said to have 2 bytes at 15, and the shard's index lies from 0 to 16; the file "
            "is damaged");
}

TEST(ShardIndex, ChunkBesideTheIndex_IsFound) {
  for (const bool index_first : {false, true}) {
    ZarrSharding sharding;
    sharding.index_first = index_first;
    std::vector<std::uint64_t> index{index_first ? 16U : 0U, 20};
    const auto places = parse_shard_index(sharding, std::as_writable_bytes(std::span(index)), 36, "s");
    ASSERT_EQ(places.size(), 1U);
    EXPECT_EQ(places[0].offset, index[0]);
    EXPECT_EQ(places[0].bytes, 20U);
  }
}

}  // namespace
}  // namespace weir::shard_index_test
