#include "gpu/volume/cached_blocks.h"

#include <gtest/gtest.h>

#include <bit>

#include "format/base/error.h"
#include "tests/support/message_of_error.h"
#include "tests/support/packed_sample.h"

namespace weir::cached_blocks_test {
namespace {

using test::PackedSample;

// One set of four blocks.
constexpr std::uint64_t kSmallCache = BlockCache::kWays * BlockCache::kBlockBytes;

Int3 local(const Index3& i) {
  const Index3 at = i - PackedSample::kDomain.lo;
  return {static_cast<std::int32_t>(at.x), static_cast<std::int32_t>(at.y), static_cast<std::int32_t>(at.z)};
}

TEST(CachedBlocks, VoxelsAndTaps_AreThoseOfTheLeafTable) {
  const test::PackedFile made = PackedSample::build();
  const NvdbGrid grid = NvdbGrid::open(made.file, "a.nvdb");
  const LeafTable decoded(grid);
  CachedBlocks blocks(grid, kSmallCache);
  BlockReader reader(blocks);
  const CachedTableView cached(reader);
  EXPECT_EQ(cached.extent, decoded.view().extent);
  for_each_index(PackedSample::kDomain, [&](const Index3& i) {
    ASSERT_EQ(cached.voxel(local(i)), decoded.view().voxel(local(i))) << i.x << ' ' << i.y << ' ' << i.z;
    float expected[8];
    float found[8];
    const bool one = decoded.view().taps(local(i), expected);
    ASSERT_EQ(cached.taps(local(i), found), one) << i.x << ' ' << i.y << ' ' << i.z;
    for (int k = 0; k < (one ? 1 : 8); ++k) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(found[k]), std::bit_cast<std::uint32_t>(expected[k]));
    }
  });
  EXPECT_GT(reader.counts().decoded, blocks.bytes() / BlockCache::kBlockBytes);
  EXPECT_LT(reader.counts().decoded, reader.counts().lookups);
  EXPECT_EQ(reader.counts().evicted, reader.counts().decoded - 4) << "each block but the first four of the set";
}

TEST(CachedBlocks, CacheOfAllBlocks_DecodesEachOnce) {
  const test::PackedFile made = PackedSample::build();
  const NvdbGrid grid = NvdbGrid::open(made.file, "a.nvdb");
  CachedBlocks blocks(grid, std::uint64_t{64} << 20U);
  const auto kinds = PackedSample::blocks_by_kind();
  std::uint64_t decoded = 0;
  for (int thread = 0; thread < 2; ++thread) {
    BlockReader reader(blocks);
    const CachedTableView view(reader);
    for_each_index(PackedSample::kDomain,
                   [&](const Index3& i) { ASSERT_EQ(view.voxel(local(i)), PackedSample::value(i)); });
    decoded += reader.counts().decoded;
    EXPECT_EQ(reader.counts().evicted, 0U);
  }
  EXPECT_EQ(decoded, kinds[0] + kinds[1]) << "the second reader finds what the first one decoded";
}

TEST(CachedBlocks, Bytes_AreTableTilesAndCache) {
  const test::PackedFile made = PackedSample::build();
  const NvdbGrid grid = NvdbGrid::open(made.file, "a.nvdb");
  const CachedBlocks blocks(grid, kSmallCache);
  const auto kinds = PackedSample::blocks_by_kind();
  const std::uint64_t tiles = 1 + 4;  // the background, and one per region
  EXPECT_EQ(blocks.bytes(), 4 * (kinds[0] + kinds[1] + kinds[2]) + 4 * tiles + kSmallCache);
}

TEST(CachedBlocks, DamagedStream_IsReportedWhenItIsLookedUp) {
  test::PackedFile made = PackedSample::build();
  const NvdbGrid whole = NvdbGrid::open(made.file, "a.nvdb");
  GridBlock last;
  whole.for_each_block([&](const GridBlock& block) { last = block.coded() ? block : last; });
  const auto at = static_cast<std::uint64_t>(last.stream.data - made.file.data());
  made.file[at] |= std::byte{0x80};
  const NvdbGrid grid = NvdbGrid::open(made.file, "a.nvdb");
  CachedBlocks blocks(grid, kSmallCache);
  BlockReader reader(blocks);
  const CachedTableView view(reader);
  const Index3 voxel = intersect({last.origin, last.origin + Index3{8, 8, 8}}, PackedSample::kDomain).lo;
  for (int time = 0; time < 2; ++time) {
    EXPECT_EQ(message_of_error(ErrorKind::input, [&] { view.voxel(local(voxel)); }),
              cat("a.nvdb: at byte ", at, ": a block's stream of ", last.stream.bytes, " bytes and kind 3 is damaged"));
  }
}

}  // namespace
}  // namespace weir::cached_blocks_test
