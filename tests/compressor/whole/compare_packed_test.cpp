// compare_volumes of a packed grid compares the decoded values and not the tree.
#include <gtest/gtest.h>

#include "compressor/compare/compare.h"
#include "tests/compressor/support/memory_volume.h"
#include "tests/support/packed_sample.h"

namespace weir::compare_packed_test {
namespace {

using test::PackedSample;

TEST(ComparePacked, SameVoxels_AreLossless) {
  const test::PackedFile made = PackedSample::build();
  test::MemoryVolume volume(PackedSample::kDomain, PackedSample::value);
  const Comparison c = compare_volumes(volume, NvdbGrid::open(made.file, "a.nvdb"), "a.nvdb", {});
  EXPECT_TRUE(c.error.lossless);
  EXPECT_EQ(c.voxels, static_cast<std::uint64_t>(PackedSample::kDomain.voxels()));
}

TEST(ComparePacked, OneVoxelDiffers_IsFound) {
  const test::PackedFile made = PackedSample::build();
  const Index3 where{200, 20, 30};
  test::MemoryVolume volume(PackedSample::kDomain,
                            [&](const Index3& i) { return PackedSample::value(i) + (i == where ? 0.5F : 0.0F); });
  const Comparison c = compare_volumes(volume, NvdbGrid::open(made.file, "a.nvdb"), "a.nvdb", {});
  EXPECT_EQ(c.different, 1U);
  EXPECT_EQ(c.error.max_abs, 0.5);
  EXPECT_EQ(c.max_abs_at, where);
}

}  // namespace
}  // namespace weir::compare_packed_test
