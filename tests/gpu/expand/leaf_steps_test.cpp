// Runs the device's expansion of packed grids for other readers on the host.
#include "gpu/cuda/expand/leaf_steps.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "tests/gpu/expand/host_expansion.h"
#include "tests/stock/stock_nvdb.h"
#include "tests/support/message_of_error.h"
#include "tests/support/packed_kinds.h"
#include "tests/support/packed_sample.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::leaf_steps_test {
namespace {

// Visits the voxels of the domain and some voxels around it.
void for_each_voxel(const Box& domain, const std::function<void(const Index3&)>& visit) {
  for_each_index({domain.lo - Index3{9, 9, 9}, domain.hi + Index3{9, 9, 9}}, visit);
}

NodeStatistics statistics_of(const NvdbGrid& grid) {
  NodeStatistics all;
  for_each_index(grid.index_bbox(), [&](const Index3& i) { all.add(grid.value(i)); });
  return all;
}

void expect_the_grid(const test::PackedFile& made) {
  const NvdbGrid packed = NvdbGrid::open(made.file, "a.nvdb");
  const test::Expanded expanded = test::expand(made, GridType::float32);
  const NvdbGrid grid = NvdbGrid::open(expanded.file, "b.nvdb");
  EXPECT_EQ(grid.packed(), nullptr);
  EXPECT_EQ(grid.type(), GridType::float32);
  EXPECT_EQ(grid.name(), packed.name());
  EXPECT_EQ(grid.index_bbox(), packed.index_bbox());
  EXPECT_EQ(grid.active_voxels(), static_cast<std::uint64_t>(packed.index_bbox().voxels()));
  EXPECT_EQ(grid.macrocells().cells.size(), packed.macrocells().cells.size());
  for_each_voxel(packed.index_bbox(), [&](const Index3& i) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(grid.value(i)), std::bit_cast<std::uint32_t>(packed.value(i)))
        << i.x << ' ' << i.y << ' ' << i.z;
  });
  const NodeStatistics all = statistics_of(packed);
  EXPECT_EQ(grid.value_min(), all.min);
  EXPECT_EQ(grid.value_max(), all.max);
}

TEST(ExpandedGrid, OfFloats_HasEveryBitOfThePackedOne) {
  expect_the_grid(test::PackedSample::build());
  expect_the_grid(test::build_packed_kinds());
}

TEST(ExpandedGrid, OfSixteenBits_IsOffByHalfAStepOfEachLeaf) {
  const test::PackedFile made = test::PackedSample::build();
  const NvdbGrid packed = NvdbGrid::open(made.file, "a.nvdb");
  const test::Expanded expanded = test::expand(made, GridType::fp16);
  const NvdbGrid grid = NvdbGrid::open(expanded.file, "b.nvdb");
  EXPECT_EQ(grid.type(), GridType::fp16);
  EXPECT_EQ(grid.index_bbox(), packed.index_bbox());
  double largest = 0;
  for_each_index(packed.index_bbox(), [&](const Index3& i) {
    largest = std::max(largest, static_cast<double>(std::abs(grid.value(i) - packed.value(i))));
  });
  double step = 0;
  for (const LeafStatistics& leaf : expanded.leaves) {
    step = std::max(step, static_cast<double>(leaf.max - leaf.min) / 65535);
  }
  EXPECT_GT(step, 1e-5);
  EXPECT_LE(largest, 0.51 * step);
  EXPECT_GT(largest, 0);
}

TEST(ExpandedGrid, OfSixteenBits_RefusesValuesThatTheyDoNotHold) {
  for (const std::array<float, 2>& odd :
       {std::array{0.0F, std::numeric_limits<float>::quiet_NaN()},
        std::array{1.0F, -std::numeric_limits<float>::infinity()}, std::array{-3e38F, 3e38F}}) {
    test::PackedGridOptions options;
    options.domain = {{0, 0, 0}, {16, 8, 8}};
    options.stream = [&](const Index3&) {
      std::array<float, 512> values{};
      values[7] = odd[0];
      values[77] = odd[1];
      return test::raw_stream(values);
    };
    const test::PackedFile made = test::PackedGridBuilder::build(options);
    EXPECT_EQ(message_of_error(ErrorKind::input, [&] { test::expand(made, GridType::fp16); }),
              "a.nvdb: has values that are not finite, or too far apart, for 16-bit leaves; load it as float");
    test::expand(made, GridType::float32);
  }
}

TEST(ExpandedGrid, NanovdbValidate_FindsNothingWrong) {
  TemporaryDirectory directory;
  if (run_command({"sh", "-c", "command -v nanovdb_validate"}).exit_code != 0) GTEST_SKIP() << "no nanovdb_validate";
  for (const GridType type : {GridType::float32, GridType::fp16}) {
    for (const test::PackedFile& made : {test::PackedSample::build(), test::build_packed_kinds()}) {
      const std::string path = directory / "b.nvdb";
      test::write_whole(path, test::expand(made, type).file);
      const CommandResult result = run_command({"nanovdb_validate", "-v", path});
      EXPECT_EQ(result.exit_code, 0);
      EXPECT_NE((result.out + result.err).find("passed"), std::string::npos) << result.out << result.err;
      EXPECT_EQ((result.out + result.err).find("fail"), std::string::npos) << result.out << result.err;
    }
  }
}

}  // namespace
}  // namespace weir::leaf_steps_test
