#include "ingest/synthetic/slabs.h"

#include <gtest/gtest.h>

namespace weir::slabs_test {
namespace {

TEST(Slabs, WholePlanesInRoundNumbers) {
  EXPECT_EQ(slab_at({10, 10, 100}, 0, 7000), (Box{{0, 0, 0}, {10, 10, 64}}));
  EXPECT_EQ(slab_at({10, 10, 100}, 6400, 7000), (Box{{0, 0, 64}, {10, 10, 100}}));
  EXPECT_EQ(slab_at({10, 10, 100}, 0, 1999), (Box{{0, 0, 0}, {10, 10, 16}}));
  EXPECT_EQ(slab_at({10, 10, 100}, 0, 799), (Box{{0, 0, 0}, {10, 10, 7}}));
}

TEST(Slabs, WholeRowsWhereNoPlaneFits) {
  EXPECT_EQ(slab_at({10, 50, 3}, 0, 499), (Box{{0, 0, 0}, {10, 32, 1}}));
  EXPECT_EQ(slab_at({10, 50, 3}, 320, 499), (Box{{0, 32, 0}, {10, 50, 1}}));
  EXPECT_EQ(slab_at({10, 50, 3}, 500, 499), (Box{{0, 0, 1}, {10, 32, 2}}));
}

TEST(Slabs, PartsOfARowWhereNoRowFits) {
  EXPECT_EQ(slab_at({10, 5, 3}, 10, 4), (Box{{0, 1, 0}, {4, 2, 1}}));
  EXPECT_EQ(slab_at({10, 5, 3}, 18, 4), (Box{{8, 1, 0}, {10, 2, 1}}));
  EXPECT_EQ(slab_at({10, 5, 3}, 7, 1), (Box{{7, 0, 0}, {8, 1, 1}}));
}

TEST(Slabs, CoverEveryVoxelOnceInFileOrder) {
  for (const Index3& extent :
       {Index3{7, 5, 3}, Index3{1, 1, 90}, Index3{90, 1, 1}, Index3{1, 90, 1}, Index3{1, 1, 1}}) {
    for (const std::int64_t most : {1, 2, 6, 7, 8, 34, 35, 36, 1000}) {
      std::int64_t first = 0;
      while (first < volume(extent)) {
        const Box slab = slab_at(extent, first, most);
        ASSERT_GE(slab.voxels(), 1);
        ASSERT_LE(slab.voxels(), most);
        ASSERT_TRUE((Box{{0, 0, 0}, extent}.contains(slab)));
        ASSERT_EQ(linear_index(slab.lo, extent), first);
        // The slab is contiguous: its last voxel lies where its voxel count puts it.
        ASSERT_EQ(linear_index(slab.hi - Index3{1, 1, 1}, extent), first + slab.voxels() - 1);
        first += slab.voxels();
      }
    }
  }
}

}  // namespace
}  // namespace weir::slabs_test
