#include "compressor/survey/leaf_cache.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/memory_volume.h"

namespace weir::leaf_cache_test {
namespace {

using test::bits_of;
using test::MemoryVolume;

constexpr std::uint64_t kLeafBytes = std::uint64_t{kLeafVoxels} * sizeof(float);

/// Returns a volume with a domain that cuts leaves on all sides. One leaf has only NaN.
MemoryVolume volume_with_edges() {
  return {Box{{-3, 5, 2}, {21, 30, 19}}, [](const Index3& i) {
            if (floor_div(i, kLeafDim) == Index3{1, 2, 1}) return std::numeric_limits<float>::quiet_NaN();
            return static_cast<float>(i.x + 100 * i.y + 10000 * i.z);
          }};
}

void add_all(LeafCache& cache, const MemoryVolume& volume, const NodeLattice& leaves) {
  for (std::int64_t i = 0; i < leaves.size(); ++i) {
    const std::vector<float> values = volume.in(leaves.voxels(leaves.position(i)));
    cache.add(i, values, bits_of(values.front()) == bits_of(values.back()));
  }
}

TEST(LeafCache, GivesAnyBoxBack) {
  const MemoryVolume volume = volume_with_edges();
  const Box domain = volume.info().domain();
  const NodeLattice leaves = make_lattice(domain, kLeafDim);
  LeafCache cache(leaves, LeafCache::whole_bytes(leaves));
  EXPECT_FALSE(cache.has(domain));
  add_all(cache, volume, leaves);
  ASSERT_TRUE(cache.has(domain));
  for (const Box& box :
       {domain, Box{{-3, 5, 2}, {-2, 6, 3}}, Box{{7, 9, 8}, {17, 25, 11}}, Box{{8, 16, 8}, {16, 24, 16}}}) {
    for (const std::size_t threads : {1U, 3U}) {
      const std::vector<float> expected = volume.in(box);
      std::vector<float> values(expected.size(), -1);
      cache.copy(box, values, threads);
      for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(bits_of(values[i]), bits_of(expected[i])) << i;
    }
  }
}

TEST(LeafCache, GivesEachLeafBack) {
  const MemoryVolume volume = volume_with_edges();
  const NodeLattice leaves = make_lattice(volume.info().domain(), kLeafDim);
  LeafCache cache(leaves, LeafCache::whole_bytes(leaves));
  add_all(cache, volume, leaves);
  std::array<float, kLeafVoxels> room{};
  for (std::int64_t i = 0; i < leaves.size(); ++i) {
    const Box inside = leaves.voxels(leaves.position(i));
    const std::vector<float> expected = volume.in(inside);
    const std::span<const float> values = cache.leaf(inside, room);
    ASSERT_EQ(values.size(), expected.size());
    for (std::size_t v = 0; v < values.size(); ++v) ASSERT_EQ(bits_of(values[v]), bits_of(expected[v])) << i;
  }
}

TEST(LeafCache, KeepsTheFirstOnesUntilItsMemoryIsFull) {
  const MemoryVolume volume = volume_with_edges();
  const NodeLattice leaves = make_lattice(volume.info().domain(), kLeafDim);
  LeafCache cache(leaves, LeafCache::index_bytes(leaves) + 5 * kLeafBytes + 17);
  add_all(cache, volume, leaves);
  std::int64_t has = 0;
  for (std::int64_t i = 0; i < leaves.size(); ++i) {
    if (!cache.has(leaves.voxels(leaves.position(i)))) continue;
    ++has;
    EXPECT_TRUE(i < 5 || leaves.first + leaves.position(i) == (Index3{1, 2, 1})) << i;
  }
  EXPECT_EQ(has, 6);  // the leaf of one value takes no room
  EXPECT_FALSE(cache.has(volume.info().domain()));
}

TEST(LeafCache, KeepsNothingWhereTheIndexAloneFills) {
  const MemoryVolume volume = volume_with_edges();
  const NodeLattice leaves = make_lattice(volume.info().domain(), kLeafDim);
  LeafCache cache(leaves, LeafCache::index_bytes(leaves) + kLeafBytes - 1);
  add_all(cache, volume, leaves);
  EXPECT_FALSE(cache.has(leaves.voxels(Index3{0, 0, 0})));
}

TEST(LeafCache, IsLeftOutWhereTheKernelRefuses) {
  const NodeLattice leaves = make_lattice(Box{{0, 0, 0}, {1 << 20, 1 << 20, 1 << 20}}, kLeafDim);
  EXPECT_EQ(LeafCache::where_there_is_room(leaves, std::uint64_t{1} << 60U), nullptr);
  const NodeLattice few = make_lattice(Box{{0, 0, 0}, {8, 8, 8}}, kLeafDim);
  EXPECT_NE(LeafCache::where_there_is_room(few, 10'000), nullptr);
}

}  // namespace
}  // namespace weir::leaf_cache_test
