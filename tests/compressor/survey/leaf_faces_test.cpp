#include "compressor/survey/leaf_faces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "format/leaf/bounds.h"

namespace weir::leaf_faces_test {
namespace {

// Returns the bounds of the finite values at those voxels of `extent` for which `is_in` is true.
template <typename IsIn>
MinMax bounds_where(const std::vector<float>& values, const Index3& extent, const IsIn& is_in) {
  MinMax bounds = kNoBounds;
  for_each_index({{0, 0, 0}, extent}, [&](const Index3& i) {
    const float v = values[static_cast<std::size_t>(linear_index(i, extent))];
    if (is_in(i) && std::isfinite(v)) widen(bounds, {v, v});
  });
  return bounds;
}

bool touches(std::int64_t i, std::int64_t extent, std::int64_t side) {
  return side == 0 || i == (side < 0 ? 0 : extent - 1);
}

TEST(LeafFaces, BoundsCoverTheVoxelsTouchedFromANeighbour) {
  std::mt19937 random(3);
  for (const Index3& extent : {Index3{8, 8, 8}, Index3{1, 8, 5}, Index3{3, 1, 1}, Index3{1, 1, 1}}) {
    std::vector<float> values(static_cast<std::size_t>(volume(extent)));
    for (float& v : values) v = static_cast<float>(random() % 1000);
    const LeafFaces faces = faces_of(values, extent);
    for_each_index({{-1, -1, -1}, {2, 2, 2}}, [&](const Index3& toward) {
      if (toward == Index3{}) return;
      const MinMax exact = bounds_where(values, extent, [&](const Index3& i) {
        return touches(i.x, extent.x, toward.x) && touches(i.y, extent.y, toward.y) && touches(i.z, extent.z, toward.z);
      });
      EXPECT_EQ(faces.touched_from(toward).min, exact.min) << toward.x << toward.y << toward.z;
      EXPECT_EQ(faces.touched_from(toward).max, exact.max) << toward.x << toward.y << toward.z;
    });
  }
}

TEST(LeafFaces, LeaveOutWhatIsNotFinite) {
  std::vector<float> values(512, std::numeric_limits<float>::quiet_NaN());
  values[7] = 3;  // x = 7, y = z = 0
  values[6] = std::numeric_limits<float>::infinity();
  const LeafFaces faces = faces_of(values, {8, 8, 8});
  EXPECT_EQ(faces.touched_from({1, 0, 0}).min, 3);
  EXPECT_EQ(faces.touched_from({1, 0, 0}).max, 3);
  EXPECT_GT(faces.touched_from({-1, 0, 0}).min, faces.touched_from({-1, 0, 0}).max) << "nothing";
  EXPECT_EQ(faces.touched_from({1, -1, -1}).min, 3);
}

}  // namespace
}  // namespace weir::leaf_faces_test
