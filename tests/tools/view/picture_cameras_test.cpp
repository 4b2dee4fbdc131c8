// Tests that the camera for probing equals the picture's camera, whatever it frames.
#include "tools/view/picture_cameras.h"

#include <gtest/gtest.h>

#include <array>

#include "gpu/scene/scene_camera.h"
#include "tests/tools/support/converted_volume.h"
#include "tests/tools/view/served_view.h"
#include "tests/tools/view/view_client.h"
#include "tools/options/backend_choice.h"

namespace weir::picture_cameras_test {
namespace {

constexpr Box kAll{{0, 0, 0}, {40, 30, 20}};
constexpr Box kContent{{16, 0, 0}, {40, 30, 20}};  // macrocells of 16 voxels; x below 20 is background

class PictureCamerasTest : public ConvertedVolume {
 protected:
  Camera camera(const Scene& scene) {
    RenderOptions options;
    options.width = 64;
    options.height = 48;
    return cameras_.camera(file_, scene, options);
  }
  void expect_framed(const Scene& scene, const Box& box) {
    const Camera found = camera(scene);
    const Camera expected = make_camera(scene.camera, frame_of(file_->grid()), std::array{box}, 64.0 / 48);
    EXPECT_FLOAT_EQ(found.position.x, expected.position.x);
    EXPECT_FLOAT_EQ(found.position.y, expected.position.y);
    EXPECT_FLOAT_EQ(found.position.z, expected.position.z);
    EXPECT_FLOAT_EQ(found.right.x, expected.right.x);
  }

  std::shared_ptr<const NvdbFile> file_ = std::make_shared<const NvdbFile>(volume_);
  PictureCameras cameras_{own_macrocell(*make_cpu_backend(1))};
};

TEST_F(PictureCamerasTest, Content_IsWhatTheSceneShows) {
  Scene scene;
  for (const RenderMode mode : {RenderMode::path, RenderMode::dvr, RenderMode::iso, RenderMode::mip}) {
    scene.mode = mode;
    expect_framed(scene, kContent);
  }
  scene.mode = RenderMode::iso;
  scene.volume.iso = 1e6;  // a value that no voxel has
  expect_framed(scene, kAll);
}

TEST_F(PictureCamerasTest, Volume_IsAllOfIt) {
  Scene scene;
  scene.camera.framing = Framing::volume;
  expect_framed(scene, kAll);
}

TEST_F(PictureCamerasTest, Region_BoundsWhatIsFramed) {
  Scene scene;
  scene.volume.region = Box{{30, 5, 2}, {100, 20, 10}};
  const Box region{{30, 5, 2}, {40, 20, 10}};
  expect_framed(scene, region);
  scene.camera.framing = Framing::volume;
  expect_framed(scene, region);
  scene.volume.region = Box{{100, 0, 0}, {200, 10, 10}};
  expect_framed(scene, kAll);
}

TEST_F(PictureCamerasTest, LargerMacrocells_AreFramedAsTheyAre) {
  PictureCameras coarse(32);
  Scene scene;
  const Camera expected = make_camera(scene.camera, frame_of(file_->grid()), std::array{kAll}, 1);
  RenderOptions options;
  options.width = 48;
  options.height = 48;
  EXPECT_FLOAT_EQ(coarse.camera(file_, scene, options).position.x, expected.position.x);
}

TEST_F(PictureCamerasTest, CellsOfAFile_AreThoseOfThatFile) {
  const std::string raw = directory_ / "zeros_40x30x20_float32.raw";
  std::vector<float> values(40 * 30 * 20, 0.0F);
  for (std::size_t i = 0; i < values.size(); i += 40) values[i] = 1;  // at x = 0
  std::string bytes(values.size() * sizeof(float), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  write_file(raw, bytes);
  const std::string other = directory_ / "other.nvdb";
  ASSERT_EQ(run_weir({"convert", raw, "-o", other, "--lossless"}).exit_code, 0);
  Scene scene;
  expect_framed(scene, kContent);
  file_ = std::make_shared<const NvdbFile>(other);
  expect_framed(scene, {{0, 0, 0}, {16, 30, 20}});
  file_ = std::make_shared<const NvdbFile>(volume_);
  expect_framed(scene, kContent);
}

// Looks along -y, at the middle of the framed box.
TEST_F(PictureCamerasTest, Probe_HonoursTheFrame) {
  ServedView served(volume_);
  ViewClient client(served.port());
  const auto x_of_middle = [&](int id, const std::string& frame) {
    client.show(id, false,
                {{"scene", "mode = \"mip\"\n[camera]\nazimuth = 90\nelevation = 0\nframe = \"" + frame + "\"\n"}});
    client.send({{"type", "probe"}, {"id", id}, {"x", 0.5}, {"y", 0.5}});
    const nlohmann::json answer = client.text("value").value();
    EXPECT_EQ(answer["found"], true) << answer;
    return answer["voxel"][0].get<double>() + 0.5;
  };
  EXPECT_NEAR(x_of_middle(1, "content"), 28, 0.75);
  EXPECT_NEAR(x_of_middle(2, "volume"), 20, 0.75);
}

}  // namespace
}  // namespace weir::picture_cameras_test
