#include "gpu/volume/level_bounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "gpu/math/random.h"
#include "gpu/volume/mean_pyramid.h"

namespace weir::level_bounds_test {
namespace {

constexpr Box kDomain{{-5, 120, 9}, {92, 181, 90}};
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// A volume with its macrocells and levels.
struct Scene {
  Scene(const std::function<float(const Index3&)>& value, int first, std::int64_t edge)
      : volume(frame(), values(value), 0.0F),
        cells(macrocells_of(volume, edge)),
        pyramid(kDomain, volume.view(), first, 1) {}

  static GridFrame frame() {
    GridFrame frame;
    frame.domain = kDomain;
    return frame;
  }
  static std::unique_ptr<const float[]> values(const std::function<float(const Index3&)>& value) {
    auto values = std::make_unique<float[]>(static_cast<std::size_t>(kDomain.voxels()));
    std::size_t k = 0;
    for (std::int64_t z = kDomain.lo.z; z < kDomain.hi.z; ++z) {
      for (std::int64_t y = kDomain.lo.y; y < kDomain.hi.y; ++y) {
        for (std::int64_t x = kDomain.lo.x; x < kDomain.hi.x; ++x) values[k++] = value({x, y, z});
      }
    }
    return values;
  }
  LevelledVolume<DenseSampler, DenseSampler> seen(const LevelChoice& choice) const {
    return {{volume.view(), Filter::trilinear}, pyramid.view(), choice};
  }
  // Returns the cell of a position in voxels from the domain's lowest corner.
  std::size_t cell_of(const Float3& p) const {
    const CellLattice lattice = cells.lattice();
    const auto along = [&](float at, std::int32_t shift) {
      return static_cast<std::int32_t>((at + static_cast<float>(shift)) / lattice.edge);
    };
    return static_cast<std::size_t>(table_index(
        {along(p.x, lattice.shift.x), along(p.y, lattice.shift.y), along(p.z, lattice.shift.z)}, lattice.count));
  }

  DenseVolume volume;
  MacrocellGrid cells;
  MeanPyramid pyramid;
};

float noise(const Index3& i) {
  return Random(1, static_cast<std::uint64_t>((i.x + 999) * 1000003 + i.y * 1009 + i.z), 5).uniform() - 0.25F;
}

float with_holes(const Index3& i) { return i.x > 60 && i.z > 30 ? kNaN : noise(i); }

LevelChoice looking_from(const Float3& eye, float camera, float scattered) {
  LevelChoice choice;
  choice.eye = eye;
  choice.stretch = {1, 1, 1.5F};
  choice.camera = camera;
  choice.scattered = camera + scattered;
  return choice;
}

TEST(LevelBounds, EveryFiniteLookUp_LiesWithinThoseOfItsCell) {
  for (const auto& [value, first, edge] :
       {std::tuple{&noise, 1, 16}, std::tuple{&noise, 3, 32}, std::tuple{&with_holes, 2, 16}}) {
    const Scene scene(value, first, edge);
    for (const LevelChoice& choice :
         {looking_from({-80, 30, 20}, -5, 0), looking_from({40, 30, 20}, -3, 0), looking_from({40, 30, 20}, -3, 3),
          looking_from({40, 300, 20}, -8, -2), looking_from({200, 30, 20}, -1, 0)}) {
      const std::vector<MinMax> bounds = scene.pyramid.bounds(scene.cells, choice, 2);
      const auto seen = scene.seen(choice);
      Random random(7, 3, 1);
      int finite = 0;
      for (int i = 0; i < 30000; ++i) {
        const Float3 p{random.uniform() * 97, random.uniform() * 61, random.uniform() * 81};
        const MinMax& cell = bounds[scene.cell_of(p)];
        for (const RayKind kind : {RayKind::camera, RayKind::scattered}) {
          const float found = seen.sample(p, kind, random);
          if (!std::isfinite(found)) continue;
          ++finite;
          ASSERT_GE(found, cell.min - 1e-6F) << p.x << ' ' << p.y << ' ' << p.z << ' ' << choice.level(p, kind);
          ASSERT_LE(found, cell.max + 1e-6F) << p.x << ' ' << p.y << ' ' << p.z << ' ' << choice.level(p, kind);
        }
      }
      EXPECT_GT(finite, 20000);
    }
  }
}

// One bright voxel: its mean on a level is seen only from the cells that the level's texels around it touch.
TEST(LevelBounds, ReachNoFartherThanTheTexelsOfTheLevelsUsed) {
  const Index3 bright{40, 150, 50};  // from the domain's corner: 45, 30, 41
  const Scene scene([&](const Index3& i) { return i == bright ? 1.0F : 0.0F; }, 1, 16);
  for (const int level : {1, 2, 3}) {
    // The eye is so far away that the level is the same everywhere.
    const LevelChoice choice = looking_from({-1e6F, 30, 20}, static_cast<float>(level) - std::log2(1e6F) - 1e-3F, 0);
    const std::vector<MinMax> bounds = scene.pyramid.bounds(scene.cells, choice, 1);
    const auto edge = static_cast<float>(1 << level);
    // Two texels around the texel of the voxel, and twice the width for the coarser level of the mixture.
    const float reach = 3 * 2 * edge;
    int bright_cells = 0;
    const CellLattice lattice = scene.cells.lattice();
    for (std::size_t c = 0; c < bounds.size(); ++c) {
      EXPECT_EQ(bounds[c].min, 0);
      if (bounds[c].max == 0) continue;
      ++bright_cells;
      EXPECT_LE(bounds[c].max, 1.0F / (edge / 2 * edge / 2 * edge / 2)) << level;
      const auto nx = static_cast<std::size_t>(lattice.count.x);
      const auto ny = static_cast<std::size_t>(lattice.count.y);
      const auto expect_near = [&](std::size_t cell, std::int32_t shift, float at) {
        const float low = static_cast<float>(cell) * 16 - static_cast<float>(shift);
        EXPECT_LT(low - reach, at) << level;
        EXPECT_GT(low + 16 + reach, at) << level;
      };
      expect_near(c % nx, lattice.shift.x, 45.5F);
      expect_near(c / nx % ny, lattice.shift.y, 30.5F);
      expect_near(c / nx / ny, lattice.shift.z, 41.5F);
    }
    EXPECT_GE(bright_cells, 1);
    EXPECT_LT(bright_cells, level == 3 ? 28 : 9) << level;
  }
}

// A voxel outside a cell's apron lies in a texel that the cell's look-ups reach, but only if they read levels.
TEST(LevelBounds, NearTheEye_AreThoseOfTheVoxels_AndInADraftOfTheFirstLevel) {
  const Index3 bright{32 + 2, 150, 50};  // the third voxel past a border of cells
  const Scene scene([&](const Index3& i) { return i == bright ? 1.0F : 0.0F; }, 2, 16);
  const LevelChoice choice = looking_from({48, 30, 40}, -20, 0);
  const std::vector<MinMax> seen = scene.pyramid.bounds(scene.cells, choice, 1);
  for (std::size_t c = 0; c < seen.size(); ++c) {
    EXPECT_EQ(seen[c].min, scene.cells.bounds()[c].min);
    EXPECT_EQ(seen[c].max, scene.cells.bounds()[c].max);
  }
  const std::vector<MinMax> drafts = scene.pyramid.bounds(scene.cells, choice, 1, true);
  // A position in the cell below the border, from the domain's lowest corner.
  const std::size_t below = scene.cell_of({36.5F, 30.5F, 41.5F});
  EXPECT_EQ(seen[below].max, 0);
  EXPECT_EQ(drafts[below].max, 1.0F / 64);
}

TEST(LevelBounds, UnknownBoundsOfVoxels_StayUnknownWhereVoxelsAreSeen) {
  const Scene scene(noise, 1, 16);
  const MacrocellGrid unknown(scene.cells.nodes(), std::vector<MinMax>(scene.cells.bounds().size(), {kNaN, kNaN}));
  for (const MinMax& cell : scene.pyramid.bounds(unknown, looking_from({48, 30, 40}, -20, 0), 1)) {
    EXPECT_TRUE(std::isnan(cell.min));
    EXPECT_TRUE(std::isnan(cell.max));
  }
  for (const MinMax& cell : scene.pyramid.bounds(unknown, looking_from({1e6F, 30, 40}, -18, 0), 1)) {
    EXPECT_TRUE(std::isfinite(cell.min));
  }
}

}  // namespace
}  // namespace weir::level_bounds_test
