// Tests which axes of an array make the volume, and the positions on its other axes.
#include "ingest/hdf5/meaning/volume_slice.h"

#include "tests/ingest/support/scratch.h"

namespace weir::volume_slice_test {
namespace {

std::vector<AxisPlace> axes(const std::vector<std::int64_t>& extents) {
  std::vector<AxisPlace> all;
  for (const std::int64_t extent : extents) all.push_back({extent, {}, {}, {}, {}});
  return all;
}

TEST(VolumeSlice, TheLastAxisIsX) {
  std::vector<AxisPlace> named = axes({4, 5, 6, 7});
  named[1] = {5, "lev", 2.0, -1.0, {}};
  named[2] = {6, "lat", 0.5, {}, {}};
  named[3] = {7, "lon", {}, 3.0, {}};
  const VolumeSlice slice = volume_slice(named, {3}, "here");
  EXPECT_EQ(slice.extent, (Index3{7, 6, 5}));
  EXPECT_EQ(slice.index, (std::vector<std::int64_t>{3}));
  EXPECT_EQ(slice.labels, (std::array<std::string, 3>{"lon", "lat", "lev"}));
  EXPECT_EQ(slice.spacing, (std::array<double, 3>{1, 0.5, 2}));
  EXPECT_EQ(slice.origin, (std::array<double, 3>{3, 0, -1}));
}

TEST(VolumeSlice, LeadingAxesOfOneElementNeedNoIndex) {
  EXPECT_EQ(leading_axes(axes({5, 6, 7})), 0U);
  EXPECT_EQ(leading_axes(axes({1, 1, 5, 6, 7})), 0U);
  EXPECT_EQ(leading_axes(axes({1, 2, 5, 6, 7})), 2U);
  EXPECT_EQ(volume_slice(axes({1, 1, 5, 6, 7}), {}, "here").index, (std::vector<std::int64_t>{0, 0}));
  EXPECT_EQ(volume_slice(axes({5, 6, 7}), {}, "here").index, std::vector<std::int64_t>{});
}

TEST(VolumeSlice, AnIndexThatDoesNotFitIsAnErrorOfUse) {
  const auto refused = [](const std::vector<std::int64_t>& extents, const std::vector<std::int64_t>& index) {
    return message_of_error(ErrorKind::usage, [&] { volume_slice(axes(extents), index, "here"); });
  };
  EXPECT_EQ(refused({4, 5, 6, 7}, {}),
            "here: its axes are 4 x 5 x 6 x 7, and a volume has three; give --index with 1 position: axis 0 in 0..3");
  EXPECT_EQ(refused({4, 5, 6, 7}, {4}),
            "here: its axes are 4 x 5 x 6 x 7, and --index has 4; give --index with 1 position: axis 0 in 0..3");
  EXPECT_EQ(refused({4, 5, 6, 7}, {1, 2}),
            "here: its axes are 4 x 5 x 6 x 7, and --index has 2 positions; give --index "
            "with 1 position: axis 0 in 0..3");
  EXPECT_EQ(refused({5, 6, 7}, {0}), "here: its axes are 5 x 6 x 7, and --index has 1 position; leave --index out");
}

TEST(VolumeSlice, RefusedPosition_SaysWhichWereNotWritten) {
  std::vector<AxisPlace> shorter = axes({2, 5, 6, 7});
  const auto refused = [&] { return message_of_error(ErrorKind::usage, [&] { volume_slice(shorter, {2}, "here"); }); };
  const std::string said =
      "here: its axes are 2 x 5 x 6 x 7, and --index has 2; give --index with 1 position: axis 0 in ";
  shorter[0].unwritten = 1;
  EXPECT_EQ(refused(), said + "0..1 (2 was not written)");
  shorter[0].unwritten = 3;
  EXPECT_EQ(refused(), said + "0..1 (2 to 4 were not written)");
}

TEST(VolumeSlice, AxisOfComponentsNeedsAChoice) {
  const auto vectors = axes({4, 20, 21, 22, 3});
  const auto refused = [&](const std::vector<std::int64_t>& index, const std::optional<ComponentChoice>& component) {
    return message_of_error(ErrorKind::usage, [&] { volume_slice(vectors, index, "here", component); });
  };
  const VolumeSlice slice = volume_slice(vectors, {2}, "here", ComponentChoice{true, 0});
  EXPECT_EQ(slice.extent, (Index3{22, 21, 20}));
  EXPECT_EQ(slice.index, std::vector<std::int64_t>{2});
  EXPECT_EQ(slice.components.count, 3);
  EXPECT_EQ(leading_axes(vectors), 1U);
  EXPECT_EQ(refused({2}, {}),
            "here: its axes are 4 x 20 x 21 x 22 x 3, the last of them of components (by its extent alone); give "
            "--component: 0 to 2, x, y, z or magnitude; or --index with 2 positions for volumes of 3 voxels along x");
  EXPECT_EQ(refused({2}, ComponentChoice{false, 3}),
            "here: its axes are 4 x 20 x 21 x 22 x 3, and --component is 3; give 0 to 2, x, y, z or magnitude");
  EXPECT_EQ(refused({}, ComponentChoice{false, 0}),
            "here: its axes are 4 x 20 x 21 x 22 x 3, and a volume has three; give --index with 1 position: axis 0 in "
            "0..3");
}

TEST(VolumeSlice, PositionsForAllButThreeAxesReadComponentsAsX) {
  const VolumeSlice slice = volume_slice(axes({20, 21, 22, 3}), {7}, "here");
  EXPECT_EQ(slice.extent, (Index3{3, 22, 21}));
  EXPECT_EQ(slice.components.count, 1);
}

TEST(VolumeSlice, ComponentOfAScalarFieldIsAnErrorOfUse) {
  EXPECT_EQ(message_of_error(ErrorKind::usage,
                             [&] {
                               volume_slice(axes({5, 6, 7}), {}, "here", ComponentChoice{true, 0});
                             }),
            "here: its axes are 5 x 6 x 7, none of them of components; leave --component out");
}

}  // namespace
}  // namespace weir::volume_slice_test
