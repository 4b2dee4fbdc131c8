// Tests how BoxCuts cuts a box into parts of a limited size, along the edges of storage units.
#include "ingest/hdf5/storage/stored_boxes.h"

#include <gtest/gtest.h>

#include <vector>

namespace weir::box_cuts_test {
namespace {

TEST(BoxCuts, PartsCoverTheBoxExactlyOnce) {
  for (const Box& box : {Box{{0, 0, 0}, {10, 9, 8}}, Box{{3, 5, 7}, {10, 9, 8}}, Box{{9, 8, 7}, {10, 9, 8}}}) {
    for (const Index3& unit : {Index3{1, 1, 1}, Index3{4, 3, 2}, Index3{16, 16, 16}}) {
      for (const Index3& corner : {Index3{0, 0, 0}, Index3{1, 2, 1}}) {
        for (const std::int64_t voxels : {1, 24, 100, 100000}) {
          const BoxCuts cuts(box, unit, corner, voxels);
          std::vector<int> seen(720, 0);
          for (std::int64_t i = 0; i < cuts.size(); ++i) {
            const Box part = cuts.part(i);
            ASSERT_FALSE(part.empty());
            ASSERT_TRUE(box.contains(part));
            // A part may exceed the limit only up to one whole unit.
            EXPECT_LE(part.voxels(), std::max(voxels, volume(unit)));
            for (std::int64_t v = 0; v < part.voxels(); ++v) {
              ++seen[static_cast<std::size_t>(linear_index(part.lo + index_at(v, part.extent()), {10, 9, 8}))];
            }
          }
          for (std::int64_t v = 0; v < 720; ++v) {
            EXPECT_EQ(seen[static_cast<std::size_t>(v)], box.contains(index_at(v, {10, 9, 8})) ? 1 : 0);
          }
        }
      }
    }
  }
}

TEST(BoxCuts, CutsLieOnUnitEdges) {
  const BoxCuts cuts({{1, 1, 1}, {30, 30, 30}}, {8, 4, 2}, {2, 1, 0}, 200);
  for (std::int64_t i = 0; i < cuts.size(); ++i) {
    const Box part = cuts.part(i);
    EXPECT_TRUE(part.lo.x == 1 || (part.lo.x - 2) % 8 == 0) << part.lo.x;
    EXPECT_TRUE(part.lo.y == 1 || (part.lo.y - 1) % 4 == 0) << part.lo.y;
    EXPECT_TRUE(part.lo.z == 1 || part.lo.z % 2 == 0) << part.lo.z;
  }
}

TEST(BoxCuts, HasNoMoreUnitsThanAreAllowed) {
  const Box box{{0, 0, 0}, {64, 64, 64}};
  EXPECT_EQ(BoxCuts(box, {4, 4, 4}, {0, 0, 0}, 1 << 18, 3).part(0), (Box{{0, 0, 0}, {12, 4, 4}}));
  EXPECT_EQ(BoxCuts(box, {4, 4, 4}, {0, 0, 0}, 1 << 18, 40).part(0), (Box{{0, 0, 0}, {64, 8, 4}}));
  EXPECT_EQ(BoxCuts(box, {4, 4, 4}, {0, 0, 0}, 1 << 18, 512).part(0), (Box{{0, 0, 0}, {64, 64, 8}}));
  // A box of one plane of voxels crosses as many units as a box of four planes.
  EXPECT_EQ(BoxCuts({{0, 0, 0}, {64, 64, 1}}, {4, 4, 4}, {0, 0, 0}, 1 << 18, 40).part(0), (Box{{0, 0, 0}, {64, 8, 1}}));
  EXPECT_EQ(BoxCuts(box, {4, 4, 4}, {0, 0, 0}, 1 << 18, 0).part(0), (Box{{0, 0, 0}, {4, 4, 4}}));
}

TEST(BoxCuts, GrowsAlongXThenYThenZ) {
  EXPECT_EQ(BoxCuts({{0, 0, 0}, {8, 8, 8}}, {2, 2, 2}, {0, 0, 0}, 16).part(0), (Box{{0, 0, 0}, {4, 2, 2}}));
  EXPECT_EQ(BoxCuts({{0, 0, 0}, {8, 8, 8}}, {2, 2, 2}, {0, 0, 0}, 64).part(0), (Box{{0, 0, 0}, {8, 4, 2}}));
  EXPECT_EQ(BoxCuts({{0, 0, 0}, {8, 8, 8}}, {2, 2, 2}, {0, 0, 0}, 256).part(0), (Box{{0, 0, 0}, {8, 8, 4}}));
  EXPECT_EQ(BoxCuts({{0, 0, 0}, {8, 8, 8}}, {2, 2, 2}, {0, 0, 0}, 4096).size(), 1);
}

}  // namespace
}  // namespace weir::box_cuts_test
