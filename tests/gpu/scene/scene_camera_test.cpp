#include "gpu/scene/scene_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "format/base/error.h"

namespace weir::scene_camera_test {
namespace {

const GridFrame kCube{{{10, 20, 30}, {110, 120, 130}}, {0.5, 0.5, 0.5}, {1, 2, 3}};

Camera orbit(const SceneCamera& scene, const GridFrame& frame, double aspect = 1) {
  const std::vector<Box> all{frame.domain};
  return make_camera(scene, frame, all, aspect);
}

void expect_near(const Float3& a, const Float3& b, float tolerance = 1e-5F) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

// Returns where a physical point appears in the picture: (0, 0) is the upper left corner, (1, 1) the lower right.
std::array<float, 2> project(const Camera& camera, const Float3& stretch, const Float3& index) {
  const Float3 d = (index - camera.position) * stretch;
  const float depth = dot(d, camera.forward);
  return {0.5F + 0.5F * dot(d, camera.right) / dot(camera.right, camera.right) / depth,
          0.5F + 0.5F * dot(d, camera.down) / dot(camera.down, camera.down) / depth};
}

TEST(GridFrame, PlaceInTheWorld_IsAPointOfIndexSpace) {
  const GridFrame frame{{{0, 0, 0}, {8, 8, 8}}, {2, 0.5, 1}, {0.5, -4, 10}};
  EXPECT_EQ(frame.world({3, 2, -1}), (Double3{6.5, -3, 9}));
  EXPECT_EQ(frame.index({6.5, -3, 9}), (Double3{3.5, 2.5, -0.5})) << "in the middle of that voxel";
  EXPECT_EQ(frame.index({5.5, -3.25, 9.5}), (Double3{3, 2, 0})) << "its lowest corner, and the highest one along z";
}

TEST(MakeCamera, AzimuthZeroIsOnTheXAxis) {
  SceneCamera scene;
  scene.azimuth = scene.elevation = 0;
  const Camera camera = orbit(scene, kCube);
  expect_near(camera.forward, {-1, 0, 0});
  expect_near(normalised(camera.right, {}), {0, 1, 0});
  expect_near(normalised(camera.down, {}), {0, 0, -1});
  EXPECT_NEAR(camera.position.y, 50, 1e-3F);
  EXPECT_GT(camera.position.x, 100.0F);
  scene.azimuth = 90;
  expect_near(orbit(scene, kCube).forward, {0, -1, 0});
  scene.elevation = 90;
  const Camera above = orbit(scene, kCube);
  expect_near(above.forward, {0, 0, -1});
  expect_near(normalised(above.right, {}), {-1, 0, 0});
}

TEST(MakeCamera, OtherUpVectorsGiveAnUprightCamera) {
  for (const Double3 up : {Double3{0, 1, 0}, Double3{1, 0, 0}, Double3{0, 0, -2}, Double3{1, 1, 1}}) {
    SceneCamera scene;
    scene.up = up;
    const Camera camera = orbit(scene, kCube);
    EXPECT_NEAR(dot(camera.right, camera.forward), 0, 1e-5F);
    const Float3 u{static_cast<float>(up[0]), static_cast<float>(up[1]), static_cast<float>(up[2])};
    EXPECT_LT(dot(camera.down, u), 0.0F);
  }
}

TEST(MakeCamera, UpOfAnyLengthIsADirection) {
  SceneCamera scene;
  scene.up = {0, 1, 0};
  const Camera expected = orbit(scene, kCube);
  for (const double length : {1e-320, 1e-300, 1e300}) {
    scene.up = {0, length, 0};
    const Camera camera = orbit(scene, kCube);
    expect_near(camera.forward, expected.forward);
    expect_near(camera.right, expected.right);
    expect_near(camera.position, expected.position);
  }
}

// For any shape and direction, all corners are in the picture and one touches the margin.
TEST(MakeCamera, FramesTheBox) {
  const GridFrame plate{{{-5, 0, 0}, {300, 40, 3}}, {1, 2, 7}, {0, 0, 0}};
  const GridFrame needle{{{0, 0, 0}, {1, 1, 5000}}, {1, 1, 1}, {0, 0, 0}};
  for (const GridFrame& frame : {kCube, plate, needle}) {
    for (const double aspect : {0.5, 1.0, 16.0 / 9}) {
      for (const double elevation : {-90.0, -20.0, 0.0, 35.0, 90.0}) {
        SceneCamera scene;
        scene.elevation = elevation;
        const Camera camera = orbit(scene, frame, aspect);
        const Double3 s = frame.stretch();
        const Float3 stretch{static_cast<float>(s[0]), static_cast<float>(s[1]), static_cast<float>(s[2])};
        const Index3 e = frame.domain.extent();
        float most = 0;
        for (int corner = 0; corner < 8; ++corner) {
          const Float3 c{(corner & 1) != 0 ? static_cast<float>(e.x) : 0,
                         (corner & 2) != 0 ? static_cast<float>(e.y) : 0,
                         (corner & 4) != 0 ? static_cast<float>(e.z) : 0};
          for (const float at : project(camera, stretch, c)) most = std::max(most, std::abs(at - 0.5F));
        }
        EXPECT_NEAR(most, 0.47F, 1e-3F);
      }
    }
  }
}

TEST(MakeCamera, FramesTheContentWhereItIs) {
  const std::vector<Box> content{{{90, 20, 30}, {110, 40, 50}}};
  SceneCamera scene;
  scene.azimuth = scene.elevation = 0;
  const Camera camera = make_camera(scene, kCube, content, 1);
  EXPECT_NEAR(camera.position.y, 10, 1e-3F);
  EXPECT_NEAR(camera.position.z, 10, 1e-3F);
}

TEST(MakeCamera, ZoomMagnifies) {
  SceneCamera scene;
  const Camera one = orbit(scene, kCube);
  scene.zoom = 4;
  const Camera four = orbit(scene, kCube);
  expect_near(one.position, four.position, 1e-3F);
  EXPECT_NEAR(length(one.right), 4 * length(four.right), 1e-5F);
}

TEST(MakeCamera, WorldPositions_AreOfVoxelCentres) {
  SceneCamera scene;
  scene.position = Double3{1 + 0.5 * 60, 2 + 0.5 * 70, 3};  // the centre of voxel (60, 70, 0)
  scene.look_at = Double3{1 + 0.5 * 60, 2 + 0.5 * 70, 50};
  const Camera camera = orbit(scene, kCube);
  expect_near(camera.position, {50.5F, 50.5F, -29.5F}, 1e-3F);  // counted from the domain's lowest corner
  expect_near(camera.forward, {0, 0, 1});
  EXPECT_NEAR(dot(camera.right, camera.forward), 0, 1e-6F);
}

TEST(MakeCamera, StandingAtTheTargetIsAnError) {
  SceneCamera scene;
  scene.position = scene.look_at = Double3{1, 2, 3};
  try {
    orbit(scene, kCube);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_STREQ(error.what(), "the camera stands at the point it looks at, (1, 2, 3); move one of them");
  }
}

TEST(Camera, CornersOfThePicture) {
  const Camera camera{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, -1}};
  expect_near(camera.direction(0.5F, 0.5F), {1, 0, 0});
  expect_near(camera.direction(0, 0), normalised(Float3{1, -2, 1}, {}));
  expect_near(camera.direction(1, 1), normalised(Float3{1, 2, -1}, {}));
}

}  // namespace
}  // namespace weir::scene_camera_test
