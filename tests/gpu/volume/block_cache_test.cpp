#include "gpu/volume/block_cache.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <iterator>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

namespace weir::block_cache_test {
namespace {

constexpr std::uint64_t kSetBytes = BlockCache::kWays * BlockCache::kBlockBytes;
constexpr std::array<std::uint32_t, 3> kOffsets{0, 100, 511};

std::array<float, BlockCache::kVoxels> ramp(float first) {
  std::array<float, BlockCache::kVoxels> values;
  for (float& value : values) value = first++;
  return values;
}

bool holds(const BlockCache& cache, std::uint32_t key) {
  float values[3];
  return cache.load(key, kOffsets, values);
}

TEST(BlockCache, Load_OfAStoredBlock_GivesItsValues) {
  BlockCache cache(10 * kSetBytes);
  EXPECT_FALSE(holds(cache, 7));
  EXPECT_FALSE(cache.store(7, ramp(1000), 0)) << "no other block had to go";
  float values[3];
  ASSERT_TRUE(cache.load(7, kOffsets, values));
  EXPECT_EQ(values[0], 1000.0F);
  EXPECT_EQ(values[1], 1100.0F);
  EXPECT_EQ(values[2], 1511.0F);
  EXPECT_FALSE(holds(cache, 8));
}

TEST(BlockCache, LargestKey_IsFoundAsAnyOther) {
  BlockCache cache(kSetBytes);
  cache.store(0xFFFFFFFE, ramp(5), 0);
  float values[3];
  ASSERT_TRUE(cache.load(0xFFFFFFFE, kOffsets, values));
  EXPECT_EQ(values[0], 5.0F);
}

TEST(BlockCache, Bytes_AreAtMostThoseGiven) {
  for (const std::uint64_t given : {kSetBytes, 2 * kSetBytes - 1, std::uint64_t{1} << 20U}) {
    const BlockCache cache(given);
    EXPECT_LE(cache.bytes(), given);
    EXPECT_GT(cache.bytes(), given - kSetBytes);
    EXPECT_EQ(cache.bytes(), cache.blocks() * (2048 + 8));
  }
}

TEST(BlockCache, Store_IntoAFullSet_ReplacesABlockThatWasNotRead) {
  BlockCache cache(kSetBytes);
  for (std::uint32_t key = 0; key < 4; ++key) EXPECT_FALSE(cache.store(key, ramp(0), 0));
  for (const std::uint32_t key : {0U, 1U, 3U}) EXPECT_TRUE(holds(cache, key));
  EXPECT_TRUE(cache.store(4, ramp(0), 0));
  EXPECT_FALSE(holds(cache, 2));
  for (const std::uint32_t key : {0U, 1U, 3U, 4U}) EXPECT_TRUE(holds(cache, key)) << key;
}

TEST(BlockCache, Store_WhereAllBlocksWereRead_ReplacesTheOneWhoseTurnItIs) {
  BlockCache cache(kSetBytes);
  for (std::uint32_t key = 0; key < 4; ++key) cache.store(key, ramp(0), 0);
  for (std::uint32_t key = 0; key < 4; ++key) EXPECT_TRUE(holds(cache, key));
  EXPECT_TRUE(cache.store(4, ramp(0), 6));
  EXPECT_FALSE(holds(cache, 2)) << "slot 6 mod 4";
}

TEST(BlockCache, Store_OfABlockThatIsThere_ChangesNothing) {
  BlockCache cache(kSetBytes);
  for (std::uint32_t key = 0; key < 4; ++key) cache.store(key, ramp(0), 0);
  EXPECT_FALSE(cache.store(2, ramp(0), 0));
  for (std::uint32_t key = 0; key < 4; ++key) EXPECT_TRUE(holds(cache, key));
}

// All voxels of a block have its key as their value, so a mixture of two blocks would be noticed. All voxels are
// read, so that stores overtake many reads.
TEST(BlockCache, ManyThreads_StoringInOneSet_ReadWholeBlocks) {
  BlockCache cache(kSetBytes);
  std::array<std::uint32_t, BlockCache::kVoxels> offsets;
  std::iota(offsets.begin(), offsets.end(), 0U);
  std::atomic<std::uint64_t> hits{0};
  std::atomic<std::uint64_t> mixed{0};
  const auto work = [&](std::uint32_t seed) {
    std::mt19937 random(seed);
    std::array<float, BlockCache::kVoxels> block;
    for (std::uint32_t n = 0; n < 20000; ++n) {
      const std::uint32_t key = random() % 8;
      float values[BlockCache::kVoxels];
      if (cache.load(key, offsets, values)) {
        ++hits;
        mixed += std::count(std::begin(values), std::end(values), static_cast<float>(key)) == 512 ? 0 : 1;
      } else {
        block.fill(static_cast<float>(key));
        cache.store(key, block, n);
      }
    }
  };
  {
    std::vector<std::jthread> threads;
    for (std::uint32_t seed = 0; seed < 4; ++seed) threads.emplace_back(work, seed);
  }
  EXPECT_GT(hits.load(), 1000U);
  EXPECT_EQ(mixed.load(), 0U);
}

}  // namespace
}  // namespace weir::block_cache_test
