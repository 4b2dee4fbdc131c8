#include "gpu/volume/macrocell_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gpu/volume/leaf_table.h"
#include "gpu/volume/volume_sampler.h"
#include "tests/stock/test_grid.h"

namespace weir::macrocell_grid_test {
namespace {

using test::TestGrid;
using test::TestGridOptions;

float noise(const Index3& i) {
  return Random(1, static_cast<std::uint64_t>(i.x * 1000003 + i.y * 1009 + i.z), 5).uniform();
}

// Bounds by their definition: in-domain voxels of the cell and one voxel around it.
MinMax reference(const NvdbGrid& grid, const NodeLattice& lattice, const Index3& cell) {
  const Box node = lattice.node_box(cell);
  const Box apron = intersect({node.lo - Index3{1, 1, 1}, node.hi + Index3{1, 1, 1}}, lattice.domain);
  MinMax bounds{kInfinity, -kInfinity};
  for (std::int64_t z = apron.lo.z; z < apron.hi.z; ++z) {
    for (std::int64_t y = apron.lo.y; y < apron.hi.y; ++y) {
      for (std::int64_t x = apron.lo.x; x < apron.hi.x; ++x) {
        const float v = grid.value({x, y, z});
        if (!is_finite(v)) continue;
        bounds = {std::min(bounds.min, v), std::max(bounds.max, v)};
      }
    }
  }
  return bounds;
}

void expect_reference(const NvdbGrid& grid, std::int64_t edge) {
  const MacrocellGrid cells(grid, edge);
  const NodeLattice lattice = make_lattice(grid.index_bbox(), edge);
  ASSERT_EQ(cells.bounds().size(), static_cast<std::size_t>(lattice.size()));
  for (std::int64_t i = 0; i < lattice.size(); ++i) {
    const MinMax expected = reference(grid, lattice, lattice.position(i));
    EXPECT_EQ(cells.bounds()[static_cast<std::size_t>(i)].min, expected.min) << i;
    EXPECT_EQ(cells.bounds()[static_cast<std::size_t>(i)].max, expected.max) << i;
  }
}

TEST(MacrocellGrid, GatheredFromBlocksIsExact) {
  TestGridOptions options;
  options.background = 0.5F;
  options.tiles = {{{32, 0, 0}, 8, 7, true}, {{-16, 24, 8}, 8, -7, false}};
  const TestGrid grid({{-9, -3, 5}, {37, 30, 40}}, noise, options);
  expect_reference(grid.grid(), 16);
}

TEST(MacrocellGrid, BackgroundOfAbsentRootEntriesCounts) {
  TestGridOptions options;
  options.background = 3;
  options.tiles = {{{4080, 0, 0}, 8, 1, true}, {{8200, 0, 0}, 8, 2, true}};
  expect_reference(TestGrid({}, noise, options).grid(), 16);
}

TEST(MacrocellGrid, NotANumberIsLeftOut) {
  const TestGrid grid({{0, 0, 0}, {20, 8, 8}}, [](const Index3& i) {
    if (i.x < 18) return std::numeric_limits<float>::quiet_NaN();
    return i.x == 18 ? kInfinity : 2.0F;
  });
  const MacrocellGrid cells(grid.grid(), 16);
  EXPECT_GT(cells.bounds()[0].min, cells.bounds()[0].max) << "nothing in it";
  EXPECT_EQ(cells.bounds()[1].min, 2.0F);
  EXPECT_EQ(cells.bounds()[1].max, 2.0F);
}

TEST(MacrocellGrid, MergedCellsHoldTheirParts) {
  const TestGrid grid({{-9, -3, 5}, {70, 30, 40}}, noise);
  const MacrocellGrid fine(grid.grid(), 16);
  const MacrocellGrid coarse(grid.grid(), 32);
  EXPECT_EQ(coarse.lattice().edge, 32.0F);
  EXPECT_EQ(coarse.lattice().shift, (Int3{23, 29, 5}));
  EXPECT_EQ(coarse.lattice().count, (Int3{4, 2, 2}));
  const auto lattice = make_lattice(grid.grid().index_bbox(), 32);
  for (std::int64_t i = 0; i < lattice.size(); ++i) {
    const MinMax exact = reference(grid.grid(), lattice, lattice.position(i));
    EXPECT_LE(coarse.bounds()[static_cast<std::size_t>(i)].min, exact.min);
    EXPECT_GE(coarse.bounds()[static_cast<std::size_t>(i)].max, exact.max);
  }
}

TEST(MacrocellGrid, UnknownBoundsSpreadWhenMerged) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const TransferFunction ramp({{0, 0, 0, 0}, {0, 0, 0, 0.75F}}, 0, 1);
  const MacrocellGrid cells(make_lattice({{0, 0, 0}, {32, 16, 16}}, 16), {{0, 0.5F}, {nan, 0.1F}});
  EXPECT_EQ(cells.majorants(ramp)[1], 0.75F);
}

TEST(MacrocellGrid, ContentIsOneBoxARow) {
  const MacrocellGrid cells(make_lattice({{3, 0, 0}, {64, 32, 16}}, 16),
                            {{0, 0}, {0, 1}, {0, 0}, {0, 1}, {0, 0}, {0, 0}, {0, 0}, {0, 0}});
  const auto shows = [&](std::size_t i) { return cells.bounds()[i].max > 0; };
  EXPECT_EQ(cells.content(shows), (std::vector<Box>{{{16, 0, 0}, {64, 16, 16}}}));
  EXPECT_EQ(cells.content([](std::size_t) { return false; }), (std::vector<Box>{{{3, 0, 0}, {64, 32, 16}}}));
}

// Woodcock tracking relies on this: no look-up by any filter anywhere in a cell exceeds the cell's majorant.
TEST(MacrocellGrid, MajorantsBoundEveryLookup) {
  for (std::uint64_t k = 0; k < 12; ++k) {
    Random random(4, k, 0);
    const Index3 lo{static_cast<std::int64_t>(random.bits() % 40) - 20, static_cast<std::int64_t>(random.bits() % 9),
                    static_cast<std::int64_t>(random.bits() % 9)};
    const Index3 extent{1 + static_cast<std::int64_t>(random.bits() % 40),
                        1 + static_cast<std::int64_t>(random.bits() % 30),
                        1 + static_cast<std::int64_t>(random.bits() % 20)};
    const float scale = std::pow(10.0F, 20 * (random.uniform() - 0.5F));
    const TestGrid grid({lo, lo + extent}, [&](const Index3& i) {
      const float u = noise(i);
      return u < 0.9F ? 0.0F : (u - 0.5F) * scale;
    });
    std::vector<Rgba> table(16);
    for (Rgba& entry : table) entry.a = random.bits() % 2 == 0 ? 0 : random.uniform();
    const TransferFunction transfer(table, grid.grid().value_min(), grid.grid().value_max());
    const LeafTable leaves(grid.grid());
    for (const std::int64_t edge : {std::int64_t{16}, std::int64_t{32}}) {
      const MacrocellGrid cells(grid.grid(), edge);
      const std::vector<float> majorants = cells.majorants(transfer);
      const CellLattice lattice = cells.lattice();
      for (const Filter filter : {Filter::nearest, Filter::trilinear, Filter::stochastic}) {
        const VolumeSampler sampler{leaves.view(), filter};
        for (int i = 0; i < 4000; ++i) {
          const Float3 p = sampler.extent() * Float3{random.uniform(), random.uniform(), random.uniform()};
          const auto cell = [&](float at, std::int32_t shift) {
            return static_cast<std::int64_t>((at + static_cast<float>(shift)) / lattice.edge);
          };
          const std::int64_t c =
              cell(p.x, lattice.shift.x) +
              lattice.count.x * (cell(p.y, lattice.shift.y) + lattice.count.y * cell(p.z, lattice.shift.z));
          ASSERT_LE(transfer.at(sampler.sample(p, random)).a, majorants[static_cast<std::size_t>(c)]);
        }
      }
    }
  }
}

}  // namespace
}  // namespace weir::macrocell_grid_test
