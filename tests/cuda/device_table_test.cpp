#include "gpu/cuda/volume/device_table.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "gpu/cuda/bricks/table_source.h"
#include "gpu/cuda/volume/device_macrocells.h"
#include "tests/cuda/support/device_reads.h"
#include "tests/stock/test_grid.h"

namespace weir::device_table_test {
namespace {

using test::TestGrid;
using test::TestGridOptions;

float wave(const Index3& i) {
  return std::sin(0.37F * static_cast<float>(i.x)) + 0.25F * std::cos(0.11F * static_cast<float>(i.y * i.z)) +
         0.01F * static_cast<float>(i.z);
}

/// Calls use(table) with the table of the grid on the device.
template <class Use>
decltype(auto) with_table(const NvdbGrid& grid, const Use& use) {
  const DeviceArray<std::byte> bytes(grid.data());
  if (grid.type() == GridType::float32) return use(DeviceTable<FloatBlock>(grid, bytes.data()).view());
  return use(DeviceTable<QuantisedBlock>(grid, bytes.data()).view());
}

void expect_every_voxel(const NvdbGrid& grid) {
  const std::vector<float> values = with_table(grid, [](const auto& table) { return test::read_voxels(table); });
  const Box domain = grid.index_bbox();
  ASSERT_EQ(values.size(), static_cast<std::size_t>(domain.voxels()));
  std::size_t at = 0;
  for_each_index(domain, [&](const Index3& i) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(values[at]), std::bit_cast<std::uint32_t>(grid.value(i)))
        << i.x << ' ' << i.y << ' ' << i.z;
    ++at;
  });
}

/// Returns positions all over the domain and one voxel beyond, many of them on borders of voxels, leaves and the
/// domain.
std::vector<Float3> positions(const NvdbGrid& grid) {
  const Index3 e = grid.index_bbox().extent();
  std::vector<Float3> result;
  Random random(7, 0, 0);
  for (int i = 0; i < 4096; ++i) {
    const auto along = [&](std::int64_t extent) {
      const float at = random.uniform() * static_cast<float>(extent + 2) - 1;
      return i % 3 == 0 ? std::floor(at) : (i % 3 == 1 ? 8 * std::floor(at / 8) + 0.5F : at);
    };
    const float x = along(e.x);
    const float y = along(e.y);
    result.push_back({x, y, along(e.z)});
  }
  return result;
}

class DeviceTableOfType : public testing::TestWithParam<GridType> {
 protected:
  static TestGridOptions options() {
    TestGridOptions result;
    result.type = GetParam();
    result.background = 0.25F;
    result.tiles = {{{40, 8, 0}, 8, 3.5F, true}, {{-24, 8, 0}, 8, -2, false}};
    return result;
  }
  static TestGrid grid() { return TestGrid({{-21, -5, 3}, {38, 30, 27}}, wave, options()); }
};

TEST_P(DeviceTableOfType, ReadsTheBitsThatTheHostReads) {
  WEIR_NEEDS_DEVICE();
  expect_every_voxel(grid().grid());
}

TEST_P(DeviceTableOfType, FiltersAsTheHost) {
  WEIR_NEEDS_DEVICE();
  const TestGrid volume = grid();
  const LeafTable host(volume.grid());
  const std::vector<Float3> at = positions(volume.grid());
  for (const Filter filter : {Filter::nearest, Filter::trilinear}) {
    const std::vector<float> values =
        with_table(volume.grid(), [&](const auto& table) { return test::read_smooth(table, filter, at); });
    const VolumeSampler expected{host.view(), filter};
    for (std::size_t i = 0; i < at.size(); ++i) {
      ASSERT_NEAR(values[i], expected.smooth(at[i]), filter == Filter::nearest ? 0 : 2e-6F)
          << at[i].x << ' ' << at[i].y << ' ' << at[i].z;
    }
  }
}

TEST_P(DeviceTableOfType, AStochasticTapIsTrilinearInTheMean) {
  WEIR_NEEDS_DEVICE();
  const TestGrid volume = grid();
  const LeafTable host(volume.grid());
  const std::vector<Float3> at = positions(volume.grid());
  constexpr int kDraws = 4096;
  const std::vector<float> values =
      with_table(volume.grid(), [&](const auto& table) { return test::read_stochastic(table, at, kDraws); });
  for (std::size_t i = 0; i < at.size(); ++i) {
    // Values are within 6 of each other, so the standard deviation of a mean is below 3 / 64.
    ASSERT_NEAR(values[i], (VolumeSampler{host.view(), Filter::trilinear}.smooth(at[i])), 5.5F * 3 / 64);
  }
}

// The texture unit has weights of 8 bits: an error of 2^-9 of the largest step along each axis.
TEST_P(DeviceTableOfType, TheAtlasFiltersToEightBits) {
  WEIR_NEEDS_DEVICE();
  const TestGrid volume = grid();
  const LeafTable host(volume.grid());
  const std::vector<Float3> at = positions(volume.grid());
  const std::vector<float> values = with_table(volume.grid(), [&]<class Block>(const BlockTable<Block>& table) {
    BrickCache bricks(std::make_unique<TableSource<Block>>(volume.grid(), table), BrickBudget{512U << 20U},
                      BricksKept::all);
    return test::read_smooth(bricks, Filter::trilinear, at);
  });
  const VolumeSampler expected{host.view(), Filter::trilinear};
  const float step = 6;
  for (std::size_t i = 0; i < at.size(); ++i) {
    ASSERT_NEAR(values[i], expected.smooth(at[i]), 3 * step / 512) << at[i].x << ' ' << at[i].y << ' ' << at[i].z;
  }
}

INSTANTIATE_TEST_SUITE_P(AllTypes, DeviceTableOfType,
                         testing::Values(GridType::float32, GridType::fp4, GridType::fp8, GridType::fp16,
                                         GridType::fpn),
                         [](const auto& of) { return std::string(grid_type_name(of.param)); });

TEST(DeviceTable, TilesOfEverySizeAndNegativeRoots) {
  WEIR_NEEDS_DEVICE();
  TestGridOptions options;
  options.background = -1;
  options.tiles = {{{-8, 0, 0}, 8, 2, true}, {{128, 0, 0}, 128, 3, true}, {{-256, -128, -128}, 128, 4, false}};
  expect_every_voxel(TestGrid({{-9, -4100, -3}, {5, -4090, 6}}, wave, options).grid());
}

TEST(DeviceTable, VolumesOfOneTile) {
  WEIR_NEEDS_DEVICE();
  TestGridOptions options;
  options.tiles = {{{0, 0, 0}, 128, 0.75F, true}};
  expect_every_voxel(TestGrid({}, wave, options).grid());
}

TEST(DeviceTable, OneVoxelAndLongThinVolumes) {
  WEIR_NEEDS_DEVICE();
  expect_every_voxel(TestGrid({{0, 0, 0}, {1, 1, 1}}, wave).grid());
  expect_every_voxel(TestGrid({{0, 0, 0}, {5000, 1, 3}}, wave).grid());
  expect_every_voxel(TestGrid({{-3, -4200, 7}, {-2, 30, 8}}, wave).grid());
}

TEST(DeviceTable, NanAndInfiniteValuesAreKept) {
  WEIR_NEEDS_DEVICE();
  const auto odd = [](const Index3& i) {
    return i.x == 3 ? std::nanf("") : (i.y == 2 ? kInfinity : (i.z == 1 ? -0.0F : wave(i)));
  };
  expect_every_voxel(TestGrid({{0, 0, 0}, {20, 11, 9}}, odd).grid());
}

TEST(DeviceMacrocells, GatheredBoundsEqualThoseOfTheHost) {
  WEIR_NEEDS_DEVICE();
  TestGridOptions options;
  options.background = 0.25F;
  options.tiles = {{{40, 8, 0}, 8, 3.5F, true}};
  const TestGrid volume({{-21, -5, 3}, {70, 45, 27}}, wave, options);
  const MacrocellGrid host(volume.grid(), 16);
  const std::vector<MinMax> gathered =
      with_table(volume.grid(), [&](const auto& table) { return gather_macrocells(table, host.lattice()); });
  ASSERT_EQ(gathered.size(), host.bounds().size());
  for (std::size_t i = 0; i < gathered.size(); ++i) {
    EXPECT_EQ(gathered[i].min, host.bounds()[i].min) << i;
    EXPECT_EQ(gathered[i].max, host.bounds()[i].max) << i;
  }
}

TEST(DeviceMacrocells, MajorantsEqualThoseOfTheHost) {
  WEIR_NEEDS_DEVICE();
  const TestGrid volume({{-21, -5, 3}, {70, 45, 27}}, wave);
  MacrocellGrid host(volume.grid(), 16);
  std::vector<MinMax> bounds = host.bounds();
  bounds[0] = {kInfinity, -kInfinity};
  bounds[1].max = std::nanf("");
  std::vector<Rgba> table(1000);
  for (std::size_t i = 0; i < table.size(); ++i) table[i].a = 0.5F + 0.5F * std::sin(0.1F * static_cast<float>(i));
  const TransferFunction transfer(table, -1, 2);
  DeviceMacrocells cells(bounds);
  DeviceTransfer on_device(TransferFunction({{}, {}}, 0, 1));
  on_device.replace(transfer);
  cells.update(on_device, cudaStreamPerThread);
  std::vector<float> majorants(bounds.size());
  check_cuda(cudaStreamSynchronize(cudaStreamPerThread), "test");
  check_cuda(cudaMemcpy(majorants.data(), cells.majorants(), majorants.size() * sizeof(float), cudaMemcpyDeviceToHost),
             "test");
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    EXPECT_NEAR(majorants[i], transfer.max_opacity(bounds[i].min, bounds[i].max), 2e-6F) << i;
  }
}

}  // namespace
}  // namespace weir::device_table_test
