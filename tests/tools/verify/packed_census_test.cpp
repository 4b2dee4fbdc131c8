#include "tools/verify/packed_census.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "format/nanovdb/nvdb_grid.h"
#include "tests/support/packed_sample.h"
#include "tools/verify/tree_census.h"
#include "tools/verify/volume_check.h"

namespace weir::packed_census_test {
namespace {

using test::PackedSample;

class PackedCensusTest : public testing::Test {
 protected:
  test::PackedFile made_ = PackedSample::build();
  NvdbGrid grid_ = NvdbGrid::open(made_.file, "a.nvdb");
};

TEST_F(PackedCensusTest, CountsBlocksByKind) {
  const auto kinds = PackedSample::blocks_by_kind();
  const PackedCensus census = take_packed_census(*grid_.packed());
  EXPECT_EQ(census.blocks, (std::array<std::uint64_t, kPackedKinds>{0, 0, 0, kinds[0] + kinds[1]}));
  EXPECT_EQ(census.none, kinds[2]);
  EXPECT_EQ(census.bytes[3], 2049 * kinds[0] + 5 * kinds[1]);
  EXPECT_EQ(census.directory_bytes, grid_.packed()->bytes().size() - census.bytes[3]);
  EXPECT_EQ(census.bits_a_voxel(PackedKind::mean), 0);
  EXPECT_NEAR(census.bits_a_voxel(PackedKind::raw),
              static_cast<double>(census.bytes[3]) / 64 / static_cast<double>(kinds[0] + kinds[1]), 1e-9);
  EXPECT_EQ(packed_block_count(*grid_.packed()), kinds[0] + kinds[1] + kinds[2]);
}

TEST_F(PackedCensusTest, TreeCensus_PackedGrid_HasTheTreesNodesAndTheDecodedValues) {
  float lo = 1e9F;
  float hi = -1e9F;
  for_each_index(PackedSample::kDomain, [&](const Index3& i) {
    lo = std::min(lo, PackedSample::value(i));
    hi = std::max(hi, PackedSample::value(i));
  });
  std::uint64_t done = 0;
  const TreeCensus census = take_census(grid_, [&](std::uint64_t blocks) { done = blocks; });
  EXPECT_EQ(census.leaves, 0U);
  EXPECT_EQ(census.inactive_tiles[2], 2U);
  EXPECT_EQ(census.active_voxels, 0U);
  EXPECT_EQ(census.valued_voxels, static_cast<std::uint64_t>(PackedSample::kDomain.voxels()));
  EXPECT_EQ(census.min, lo);
  EXPECT_EQ(census.max, hi);
  EXPECT_FALSE(census.outside_macrocell);
  EXPECT_GT(done, 0U);
  EXPECT_LE(done, census_blocks(grid_));
  for (const VolumeCheck& check : check_structure(grid_, census)) {
    EXPECT_EQ(check.ok, check.name != "stored range") << check.name << ": " << check.found;  // it says -1000 to 1000
  }
}

TEST_F(PackedCensusTest, Sidecar_OtherBlocksThanItSays_IsReported) {
  const auto ok_of = [&](const Sidecar& sidecar, const std::string& name) {
    for (const VolumeCheck& check : check_sidecar(grid_, take_census(grid_, {}), "", sidecar)) {
      if (check.name == name) return check.ok ? "ok" : "wrong";
    }
    return "not checked";
  };
  Sidecar sidecar;
  EXPECT_STREQ(ok_of(sidecar, "sidecar packed, selection.blocks"), "wrong");
  EXPECT_STREQ(ok_of(sidecar, "sidecar selection.leaves_kept"), "not checked");
  const auto kinds = PackedSample::blocks_by_kind();
  sidecar.packed = Sidecar::Packed{};
  sidecar.selection.blocks = {kinds[2], 0, 0, 0, kinds[0] + kinds[1]};
  sidecar.selection.leaves_kept = kinds[0] + kinds[1];
  EXPECT_STREQ(ok_of(sidecar, "sidecar selection.blocks"), "ok");
  EXPECT_STREQ(ok_of(sidecar, "sidecar packed.preview"), "ok");
  EXPECT_STREQ(ok_of(sidecar, "sidecar selection.leaves_kept"), "ok");
  EXPECT_STREQ(ok_of(sidecar, "sidecar selection.bits"), "ok");
  ++(*sidecar.selection.blocks)[1];
  ++sidecar.selection.leaves_kept;
  sidecar.selection.bits[2] = 1;
  sidecar.packed->preview = true;
  EXPECT_STREQ(ok_of(sidecar, "sidecar selection.blocks"), "wrong");
  EXPECT_STREQ(ok_of(sidecar, "sidecar packed.preview"), "wrong");
  EXPECT_STREQ(ok_of(sidecar, "sidecar selection.leaves_kept"), "wrong");
  EXPECT_STREQ(ok_of(sidecar, "sidecar selection.bits"), "wrong");
}

TEST_F(PackedCensusTest, MacrocellThatDoesNotHold_IsReported) {
  test::PackedFile damaged = made_;
  store(std::span(damaged.file), damaged.packed - 8, MinMax{0, 0});  // of the last cell
  const NvdbGrid grid = NvdbGrid::open(damaged.file, "a.nvdb");
  ASSERT_TRUE(take_census(grid, {}).outside_macrocell);
  EXPECT_EQ(floor_div(*take_census(grid, {}).outside_macrocell, 16), (Index3{16, 2, 3}));
}

// The bounds are only of a cell's own voxels, but a filtered look-up at its border also reads the voxels around it.
TEST_F(PackedCensusTest, MacrocellsWithoutTheirApron_AreReported) {
  EXPECT_FALSE(take_census(grid_, {}).outside_apron);
  const MacrocellView cells = grid_.macrocells();
  std::vector<MinMax> own(cells.cells.size(), kNoBounds);
  for_each_index(grid_.index_bbox(), [&](const Index3& i) {
    const Index3 cell = floor_div(i, cells.cell) - cells.lattice.first;
    const float value = grid_.value(i);
    if (!std::isnan(value)) widen(own[static_cast<std::size_t>(cells.lattice.linear(cell))], {value, value});
  });
  test::PackedFile narrow = made_;
  const std::size_t first = narrow.packed - own.size() * sizeof(MinMax);
  for (std::size_t i = 0; i < own.size(); ++i) store(std::span(narrow.file), first + i * sizeof(MinMax), own[i]);
  const NvdbGrid grid = NvdbGrid::open(narrow.file, "a.nvdb");
  const TreeCensus census = take_census(grid, {});
  EXPECT_FALSE(census.outside_macrocell);
  ASSERT_TRUE(census.outside_apron);
  bool told = false;
  for (const VolumeCheck& check : check_structure(grid, census)) {
    if (check.name != "macrocells") continue;
    told = true;
    EXPECT_FALSE(check.ok);
    EXPECT_TRUE(check.found.starts_with("values around the cell at ")) << check.found;
  }
  EXPECT_TRUE(told);
}

TEST_F(PackedCensusTest, Histogram_PackedGrid_CountsTheDomain) {
  const auto counts = count_values(grid_, -1000, 1000, 8, {});
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}),
            static_cast<std::uint64_t>(PackedSample::kDomain.voxels()));
}

}  // namespace
}  // namespace weir::packed_census_test
