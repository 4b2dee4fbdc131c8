#include "gpu/volume/grid_samples.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <vector>

#include "tests/support/packed_sample.h"

namespace weir::grid_samples_test {
namespace {

using test::PackedSample;

std::vector<float> values_of(GridSamples& samples, Filter filter) {
  const Index3 extent = PackedSample::kDomain.extent();
  std::vector<float> values;
  samples.with_volume(filter, [&](const auto& volume) {
    for_each_index({{0, 0, 0}, extent}, [&](const Index3& i) {
      const auto at = [](std::int64_t voxel) { return static_cast<float>(voxel) + 0.8F; };
      values.push_back(volume.smooth({at(i.x), at(i.y), at(i.z)}));
    });
  });
  return values;
}

TEST(GridSamples, PackedBlocksThatAreDecodedWhenLookedUp_GiveTheSameValuesInLessMemory) {
  const test::PackedFile made = PackedSample::build();
  const NvdbGrid grid = NvdbGrid::open(made.file, "a.nvdb");
  constexpr std::uint64_t kCache = BlockCache::kWays * BlockCache::kBlockBytes;
  GridSamples at_once(grid);
  GridSamples looked_up(grid, kCache);
  const auto kinds = PackedSample::blocks_by_kind();
  EXPECT_EQ(at_once.bytes() - looked_up.bytes(), (kinds[0] + kinds[1]) * nvdb::kFloatLeafBytes - kCache);
  for (const Filter filter : {Filter::nearest, Filter::trilinear}) {
    const std::vector<float> expected = values_of(at_once, filter);
    const std::vector<float> found = values_of(looked_up, filter);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(found[i]), std::bit_cast<std::uint32_t>(expected[i])) << i;
    }
  }
}

}  // namespace
}  // namespace weir::grid_samples_test
