#include "gpu/cuda/bricks/level_builder.h"

#include <gtest/gtest.h>

#include "gpu/volume/mean_pyramid.h"
#include "tests/gpu/bricks/host_machine.h"
#include "tests/support/packed_kinds.h"
#include "tests/support/packed_sample.h"

namespace weir::level_builder_test {
namespace {

struct WrittenTexels {
  Int3 size;
  std::span<float> texels;

  void write(const Int3& at, float value) const { texels[table_index(at, size)] = value; }
};

// The device's levels of a packed grid, made in batches of one region and of all, equal the CPU's.
void expect_levels_of_the_cpu(const test::PackedFile& made) {
  const NvdbGrid grid = NvdbGrid::open(made.file, "a.nvdb");
  const LeafTable table(grid);
  test::HostPackedSource source(*grid.packed(), grid.index_bbox());
  const std::vector<RegionEntry> regions = source.regions();
  const LevelLattice lattice = level_lattice(grid.index_bbox());
  for (int first = 1; first <= kMostFinest; ++first) {
    const MeanPyramid pyramid(grid.index_bbox(), table.view(), first, 1);
    const LevelsView<DenseSampler> expected = pyramid.view();
    for (const std::uint64_t scratch : {std::uint64_t{0}, 100 * kDecodedRegionBytes}) {
      auto level = finest_level_of(test::HostMachine{}, source, regions, lattice, first, scratch);
      for (int l = first;; ++l) {
        ASSERT_EQ(level.size(), lattice.size(l));
        std::vector<float> written(level.size());
        write_level(test::HostMachine{}, lattice.texels(l), level.data(), WrittenTexels{lattice.texels(l), written});
        for (std::size_t i = 0; i < level.size(); ++i) {
          const float cpu = expected.texels[l - first].table.values[i];
          ASSERT_TRUE(same_value(written[i], cpu)) << l << ": " << i << ": " << written[i] << ' ' << cpu;
        }
        if (l == first + expected.count - 1) break;
        level = coarser_level_of(test::HostMachine{}, lattice, l, level.data());
      }
    }
  }
}

TEST(LevelBuilder, RegionsWithAndWithoutStreams_HaveTheLevelsOfTheCpu) {
  expect_levels_of_the_cpu(test::PackedSample::build());
}

TEST(LevelBuilder, BlocksOfAllKinds_HaveTheLevelsOfTheCpu) { expect_levels_of_the_cpu(test::build_packed_kinds()); }

}  // namespace
}  // namespace weir::level_builder_test
