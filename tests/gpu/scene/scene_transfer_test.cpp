#include "gpu/scene/scene_transfer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "format/base/error.h"
#include "gpu/image/colormap.h"

namespace weir::scene_transfer_test {
namespace {

TEST(MakeTransferFunction, BackgroundIsTransparentByDefault) {
  for (const float background : {0.0F, 77.0F, 255.0F}) {
    const TransferFunction transfer = make_transfer_function({}, {0, 255}, background, "gray");
    EXPECT_EQ(transfer.at(background).a, 0.0F);
    EXPECT_EQ(transfer.at(background + (background > 200 ? -8.0F : 8.0F)).a, 0.0F) << "noise around it";
    EXPECT_NEAR(std::max(transfer.at(0).a, transfer.at(255).a), 1.0F, 1e-6F);
  }
}

TEST(MakeTransferFunction, BackgroundBesideTheRange_IsTransparentToo) {
  SceneVolume volume;
  volume.range = {{0.5, 1}};
  for (const float background : {0.0F, 0.4F, -1e30F, 0.5F}) {
    const TransferFunction above = make_transfer_function(volume, {0, 1}, background, "gray");
    EXPECT_EQ(above.at(background).a, 0.0F) << background;
    EXPECT_EQ(above.at(0.5F).a, 0.0F) << "the end nearest to it";
    EXPECT_EQ(above.max_opacity(background, background), 0.0F) << background;
    EXPECT_NEAR(above.at(1).a, 1.0F, 1e-6F);
  }
  const TransferFunction below = make_transfer_function(volume, {0, 1}, 7, "gray");
  EXPECT_EQ(below.at(7).a, 0.0F);
  EXPECT_NEAR(below.at(0.5F).a, 1.0F, 1e-6F);
  volume.range = {{0.4, 0.4}};
  const TransferFunction one = make_transfer_function(volume, {0, 1}, 0, "gray");
  EXPECT_EQ(one.at(0).a, 0.0F);
  EXPECT_EQ(one.at(0.4F).a, 0.5F);
  EXPECT_EQ(one.at(0.9F).a, 0.5F);
}

TEST(MakeTransferFunction, BackgroundThatIsNoNumber_IsTakenAsTheLowEnd) {
  for (const float background : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    const TransferFunction transfer = make_transfer_function({}, {2, 4}, background, "gray");
    EXPECT_EQ(transfer.at(background).a, 0.0F);
    EXPECT_EQ(transfer.at(2).a, 0.0F);
    EXPECT_NEAR(transfer.at(4).a, 1.0F, 1e-6F);
  }
}

TEST(MakeTransferFunction, SignedDataShowsBothSides) {
  const TransferFunction transfer = make_transfer_function({}, {-2, 2}, 0, "cool-warm");
  EXPECT_NEAR(transfer.at(-2).a, 1.0F, 1e-6F);
  EXPECT_NEAR(transfer.at(2).a, 1.0F, 1e-6F);
  EXPECT_EQ(transfer.at(0.1F).a, 0.0F);
}

TEST(MakeTransferFunction, ConstantVolumeIsHalfOpaque) {
  const TransferFunction transfer = make_transfer_function({}, {3, 3}, 3, "gray");
  EXPECT_EQ(transfer.at(3).a, 0.5F);
}

TEST(MakeTransferFunction, RangeThatOverflows) {
  const TransferFunction transfer = make_transfer_function({}, {-3e38F, 3e38F}, -3e38F, "gray");
  EXPECT_EQ(transfer.at(-3e38F).a, 0.0F);
  EXPECT_NEAR(transfer.at(3e38F).a, 1.0F, 1e-6F);
  EXPECT_TRUE(is_finite(transfer.at(0).a));
}

TEST(MakeTransferFunction, PointsOfTheScene) {
  SceneVolume volume;
  volume.range = {{100, 200}};
  volume.opacity = {{0.25, 0}, {0.75, 1}};
  volume.color = {{0, {1, 0, 0}}, {0.5, {0, 1, 0}}};
  const TransferFunction transfer = make_transfer_function(volume, {0, 1}, 0, "gray");
  EXPECT_EQ(transfer.low(), 100.0F);
  EXPECT_NEAR(transfer.at(150).a, 0.5F, 1e-3F);
  EXPECT_EQ(transfer.at(110).a, 0.0F);
  EXPECT_EQ(transfer.at(200).a, 1.0F);
  EXPECT_EQ(transfer.at(100).r, 1.0F);
  EXPECT_EQ(transfer.at(180).g, 1.0F);
  EXPECT_NEAR(transfer.at(125).r, linear_from_srgb(0.5F), 2e-3F);
}

TEST(MakeTransferFunction, TheScenesColormapWins) {
  SceneVolume volume;
  volume.colormap = "heat";
  EXPECT_EQ(make_transfer_function(volume, {0, 1}, 0, "gray").at(1).b, colormap("heat", 2)[1].z);
  volume.colormap = "no such";
  EXPECT_THROW(make_transfer_function(volume, {0, 1}, 0, "gray"), Error);
}

}  // namespace
}  // namespace weir::scene_transfer_test
