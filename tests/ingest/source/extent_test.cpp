#include "ingest/source/extent.h"

#include "tests/ingest/support/scratch.h"

namespace weir::extent_test {
namespace {

std::string refusal(const Index3& extent, std::size_t bytes) {
  return message_of_error(ErrorKind::input, [&] { checked_volume_bytes(extent, bytes, "a.raw"); });
}

TEST(Extent, CountsBytes) {
  EXPECT_EQ(checked_volume_bytes({1, 1, 1}, 1, "a"), 1U);
  EXPECT_EQ(checked_volume_bytes({3, 5, 7}, 8, "a"), 840U);
  EXPECT_EQ(checked_volume_bytes({kMaxAxis, 1, 1}, 8, "a"), 8 * 2147483647ULL);
  EXPECT_EQ(checked_volume_bytes({kMaxAxis, 1 << 29, 1}, 1, "a"), 2147483647ULL << 29U);
}

TEST(Extent, RefusesImpossibleAxes) {
  EXPECT_EQ(refusal({0, 4, 4}, 1), "a.raw: extent 0x4x4 has 0 voxels along x; each axis must be 1 to 2147483647");
  EXPECT_EQ(refusal({4, -4, 4}, 1), "a.raw: extent 4x-4x4 has -4 voxels along y; each axis must be 1 to 2147483647");
  EXPECT_EQ(refusal({4, 4, kMaxAxis + 1}, 1),
            "a.raw: extent 4x4x2147483648 has 2147483648 voxels along z; each axis must be 1 to 2147483647");
}

TEST(Extent, RefusesOverflow) {
  EXPECT_EQ(refusal({kMaxAxis, kMaxAxis, kMaxAxis}, 1),
            "a.raw: extent 2147483647x2147483647x2147483647 at 4 bytes a voxel overflows 64 bits; check the extent");
  // 2^61 voxels: their bytes fit as uint8, not as the float32 values that everything works on.
  EXPECT_EQ(refusal({1 << 30, 1 << 30, 2}, 1),
            "a.raw: extent 1073741824x1073741824x2 at 4 bytes a voxel overflows 64 bits; check the extent");
  EXPECT_EQ(refusal({1 << 30, 1 << 30, 1}, 8),
            "a.raw: extent 1073741824x1073741824x1 at 8 bytes a voxel overflows 64 bits; check the extent");
}

TEST(Extent, Text) {
  EXPECT_EQ(extent_text({256, 128, 1}), "256x128x1");
  EXPECT_EQ(box_text({{-66, 0, 1}, {60, 86, 154}}), "-66:60,0:86,1:154");
}

}  // namespace
}  // namespace weir::extent_test
