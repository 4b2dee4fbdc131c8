#include "format/sidecar/scene.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "format/base/error.h"
#include "tests/support/message_of_error.h"
#include "tests/support/temporary_directory.h"
#include "tests/support/unreadable_file.h"

namespace weir::scene_test {
namespace {

std::string message(const std::string& text) {
  try {
    parse_scene(text, "s.toml");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "no error";
}

TEST(Scene, EmptyTextIsTheDefaults) {
  const Scene scene = parse_scene("", "s.toml");
  EXPECT_EQ(scene.mode, RenderMode::path);
  EXPECT_FALSE(scene.camera.position);
  EXPECT_EQ(scene.camera.framing, Framing::content);
  EXPECT_TRUE(scene.volume.colormap.empty());
  EXPECT_FALSE(scene.volume.range);
  EXPECT_FALSE(scene.lighting.lights);
}

TEST(Scene, EveryKey) {
  const Scene scene = parse_scene(R"(
mode = "dvr"
[camera]
position = [1, 2.5, -3]
look_at = [4, 5, 6]
up = [0, 1, 0]
azimuth = -30
elevation = 90
zoom = 2
fov = 45.5
frame = "volume"
[volume]
colormap = "heat"
range = [-1.5, 20]
opacity = [[0, 0], [0.5, 0.25], [1, 1]]
color = [[0, 1, 0, 0], [1, 0, 0.5, 1]]
density = 300
albedo = 0.5
anisotropy = -0.75
emission = 2
shading = 0
iso = 7
max_bounces = 3
[lighting]
ambient = [1, 1, 1]
zenith = [0.1, 0.2, 0.3]
background = [0, 0, 1]
exposure = 1.5
[[light]]
direction = [0, 0, 1]
irradiance = [3, 2, 1]
[[light]]
direction = [1, 0, 0]
)",
                                  "s.toml");
  EXPECT_EQ(scene.mode, RenderMode::dvr);
  EXPECT_EQ(scene.camera.position, (Double3{1, 2.5, -3}));
  EXPECT_EQ(scene.camera.look_at, (Double3{4, 5, 6}));
  EXPECT_EQ(scene.camera.up, (Double3{0, 1, 0}));
  EXPECT_EQ(scene.camera.azimuth, -30);
  EXPECT_EQ(scene.camera.elevation, 90);
  EXPECT_EQ(scene.camera.zoom, 2);
  EXPECT_EQ(scene.camera.fov, 45.5);
  EXPECT_EQ(scene.camera.framing, Framing::volume);
  EXPECT_EQ(scene.volume.colormap, "heat");
  EXPECT_EQ(scene.volume.range, (std::array<double, 2>{-1.5, 20}));
  ASSERT_EQ(scene.volume.opacity.size(), 3U);
  EXPECT_EQ(scene.volume.opacity[1].position, 0.5);
  EXPECT_EQ(scene.volume.opacity[1].opacity, 0.25);
  ASSERT_EQ(scene.volume.color.size(), 2U);
  EXPECT_EQ(scene.volume.color[1].position, 1);
  EXPECT_EQ(scene.volume.color[1].srgb, (Double3{0, 0.5, 1}));
  EXPECT_EQ(scene.volume.density, 300);
  EXPECT_EQ(scene.volume.albedo, 0.5);
  EXPECT_EQ(scene.volume.anisotropy, -0.75);
  EXPECT_EQ(scene.volume.emission, 2);
  EXPECT_EQ(scene.volume.shading, 0);
  EXPECT_EQ(scene.volume.iso, 7);
  EXPECT_EQ(scene.volume.max_bounces, 3);
  EXPECT_EQ(scene.lighting.zenith, (Double3{0.1, 0.2, 0.3}));
  EXPECT_EQ(scene.lighting.horizon, (Double3{1, 1, 1})) << "ambient where nothing else is said";
  EXPECT_EQ(scene.lighting.background, (Double3{0, 0, 1}));
  EXPECT_EQ(scene.lighting.exposure, 1.5);
  ASSERT_TRUE(scene.lighting.lights);
  ASSERT_EQ(scene.lighting.lights->size(), 2U);
  EXPECT_EQ((*scene.lighting.lights)[0].irradiance, (Double3{3, 2, 1}));
  EXPECT_EQ((*scene.lighting.lights)[1].irradiance, (Double3{1, 1, 1}));
}

TEST(Scene, EnvironmentIsRelativeToTheScene) {
  const auto lighting = [](const std::string& text, const std::string& path) {
    return parse_scene("[lighting]\n" + text, path).lighting;
  };
  SceneLighting light = lighting("environment = \"sky.exr\"", "scenes/s.toml");
  EXPECT_EQ(light.environment, "scenes/sky.exr");
  EXPECT_EQ(light.environment_rotation, 0);
  EXPECT_EQ(light.environment_scale, 1);
  EXPECT_FALSE(light.environment_behind);
  light = lighting(
      "environment = \"/sky.hdr\"\nenvironment_rotation = -90\nenvironment_scale = 2.5\n"
      "background = \"environment\"",
      "scenes/s.toml");
  EXPECT_EQ(light.environment, "/sky.hdr");
  EXPECT_EQ(light.environment_rotation, -90);
  EXPECT_EQ(light.environment_scale, 2.5);
  EXPECT_TRUE(light.environment_behind);
  EXPECT_FALSE(light.background);
  EXPECT_EQ(lighting("environment = \"a.hdr\"", "s.toml").environment, "a.hdr");
  EXPECT_EQ(lighting("exposure = 1", "s.toml").environment, "");
}

TEST(Scene, EnvironmentErrors) {
  EXPECT_EQ(message("[lighting]\nenvironment = \"\""),
            "s.toml:2:15: environment is empty, it must be the path of an .exr or .hdr file");
  EXPECT_EQ(message("[lighting]\nenvironment_scale = 1"),
            "s.toml:2:21: environment_scale without environment; name the picture as environment = \"FILE\"");
  EXPECT_EQ(message("[lighting]\nzenith = [1, 1, 1]\nenvironment = \"a.exr\""),
            "s.toml:2:10: zenith beside environment, which takes its place; leave one of them out");
  EXPECT_EQ(message("[lighting]\nbackground = \"environment\""),
            "s.toml:2:14: background is \"environment\", it must be a colour, or \"environment\" where one is given");
  EXPECT_EQ(message("[lighting]\nenvironment = \"a.exr\"\nbackground = \"white\""),
            "s.toml:3:14: background is \"white\", it must be a colour, or \"environment\" where one is given");
}

TEST(Scene, UnknownKeyErrorGivesThePlaceAndTheKnownKeys) {
  EXPECT_EQ(message("mode = \"iso\"\n\n  colour = 1\n"),
            "s.toml:3:3: unknown key \"colour\" in the scene; there are camera, light, lighting, mode, volume");
  EXPECT_EQ(message("[lighting]\nsun = 1"),
            "s.toml:2:1: unknown key \"sun\" in [lighting]; there are ambient, background, environment, "
            "environment_rotation, environment_scale, exposure, ground, horizon, zenith");
  EXPECT_EQ(message("[[light]]\ndirection = [0, 0, 1]\ncolor = 1"),
            "s.toml:3:1: unknown key \"color\" in [[light]]; there are direction, irradiance");
}

TEST(Scene, WrongTypes) {
  EXPECT_EQ(message("mode = 1"), "s.toml:1:8: mode must be a string");
  EXPECT_EQ(message("mode = \"xray\""), "s.toml:1:8: mode is \"xray\", it must be path, dvr, iso or mip");
  EXPECT_EQ(message("camera = 1"), "s.toml:1:10: camera must be a table");
  EXPECT_EQ(message("light = 1"), "s.toml:1:9: light must be an array of tables, [[light]]");
  EXPECT_EQ(message("[camera]\nfov = \"wide\""), "s.toml:2:7: fov is \"wide\", it must be a number");
  EXPECT_EQ(message("[camera]\nup = [0, 1]"), "s.toml:2:6: up must be an array of 3 numbers");
  EXPECT_EQ(message("[camera]\nup = [0, 1, true]"), "s.toml:2:13: up is true, it must be a number");
  EXPECT_EQ(message("[camera]\nframe = \"all\""), "s.toml:2:9: frame is \"all\", it must be content or volume");
  EXPECT_EQ(message("[volume]\nmax_bounces = 1.5"), "s.toml:2:15: max_bounces is 1.5, it must be a whole number");
  EXPECT_EQ(message("[volume]\nopacity = [[0, 1]]"),
            "s.toml:2:11: opacity must be an array of at least two points, each an array of 2 numbers");
}

TEST(Scene, RangesAndSurfacesAreAllValuesOfFloat32) {
  const Scene scene = parse_scene(
      "[volume]\nrange = [-3.4028234663852886e38, 3.4028234663852886e38]\niso = 3.4028234663852886e38", "s.toml");
  EXPECT_EQ(scene.volume.range->at(1), static_cast<double>(std::numeric_limits<float>::max()));
  EXPECT_EQ(scene.volume.iso, static_cast<double>(std::numeric_limits<float>::max()));
}

TEST(Scene, PlacesAreAsFarAsWorldsAreLarge) {
  const Scene scene = parse_scene("[camera]\nposition = [3e22, -1e60, 0]\nlook_at = [1e16, 1e60, 0]", "s.toml");
  EXPECT_EQ(scene.camera.position, (Double3{3e22, -1e60, 0}));
  EXPECT_EQ(scene.camera.look_at, (Double3{1e16, 1e60, 0}));
  EXPECT_EQ(message("[camera]\nlook_at = [0, 0, 1e61]"),
            "s.toml:2:18: look_at is 1e+61, it must be from -1e+60 to 1e+60");
  EXPECT_EQ(message("[camera]\nup = [0, 0, 1e16]"), "s.toml:2:13: up is 1e+16, it must be from -1e+15 to 1e+15");
}

TEST(Scene, ValuesOutOfRange) {
  EXPECT_EQ(message("[volume]\nalbedo = 1.5"), "s.toml:2:10: albedo is 1.5, it must be from 0 to 1");
  EXPECT_EQ(message("[volume]\nalbedo = nan"), "s.toml:2:10: albedo is nan, it must be from 0 to 1");
  EXPECT_EQ(message("[volume]\ndensity = inf"), "s.toml:2:11: density is inf, it must be from 0 to 1e+30");
  EXPECT_EQ(message("[volume]\nrange = [2, 1]"), "s.toml:2:9: range must not fall");
  EXPECT_EQ(message("[volume]\nopacity = [[0.5, 1], [0.25, 0]]"),
            "s.toml:2:22: opacity has position 0.25 behind 0.5; positions rise");
  EXPECT_EQ(message("[volume]\ncolormap = \"jet\""),
            "s.toml:2:12: colormap is \"jet\", it must be one of gray, white, heat, cool-warm, dusk, ct, water, magma, "
            "viridis, plasma, inferno, cividis");
  EXPECT_EQ(message("[camera]\nup = [0, 0, 0]"), "s.toml:2:6: up is (0, 0, 0), it must have a direction");
  EXPECT_EQ(message("[[light]]\nirradiance = [1, 1, 1]"), "s.toml:1:1: a light needs a direction");
  std::string five;
  for (int i = 0; i < 5; ++i) five += "[[light]]\ndirection = [0, 0, 1]\n";
  EXPECT_EQ(message(five), "s.toml:1:1: there are 5 lights, at most 4");
}

TEST(Scene, BrokenTomlSaysWhere) {
  EXPECT_EQ(message("mode = \n").rfind("s.toml:1:8: ", 0), 0U) << message("mode = \n");
}

TEST(Scene, MissingFile) {
  try {
    load_scene("/nonexistent/s.toml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_STREQ(error.what(), "/nonexistent/s.toml: cannot read the scene; it must be an existing TOML file");
  }
}

TEST(Scene, Directory_IsNoScene) {
  const TemporaryDirectory directory;
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { load_scene(directory.path()); }),
            directory.path().string() + ": cannot read the scene; it must be an existing TOML file");
}

TEST(Scene, FileThatMayNotBeRead_IsAnIoError) {
  const std::string path = unreadable_file();
  if (path.empty()) GTEST_SKIP() << "this system has no file that root may not read";
  const std::string message = message_of_error(ErrorKind::io, [&] { load_scene(path); });
  EXPECT_TRUE(message.starts_with(path + ": cannot read: ")) << message;
}

TEST(Scene, FileLongerThanAnyScene_IsRefusedUnread) {
  const TemporaryDirectory directory;
  const std::string path = directory / "volume.raw";
  std::ofstream(path) << "mode = \"dvr\"\n#" << std::string(kMostSceneBytes, ' ');
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { load_scene(path); }),
            path + ": more than 1048576 bytes, no scene has; give a TOML file");
  std::filesystem::resize_file(path, kMostSceneBytes);
  EXPECT_EQ(load_scene(path).mode, RenderMode::dvr);
}

TEST(RenderModeName, RoundTrip) {
  for (const RenderMode mode : {RenderMode::path, RenderMode::dvr, RenderMode::iso, RenderMode::mip}) {
    EXPECT_EQ(parse_render_mode(render_mode_name(mode)), mode);
  }
  EXPECT_FALSE(parse_render_mode("PATH"));
}

TEST(Scene, RegionTakesWholeVoxelsOnly) {
  const Scene scene = parse_scene("[volume]\nregion = [[-8, 16], [0, 1], [3, 400]]", "s.toml");
  ASSERT_TRUE(scene.volume.region);
  EXPECT_EQ(*scene.volume.region, (Box{{-8, 0, 3}, {16, 1, 400}}));
  EXPECT_FALSE(parse_scene("[volume]\nalbedo = 1", "s.toml").volume.region);
  EXPECT_EQ(message("[volume]\nregion = [[0, 8], [0, 8]]"),
            "s.toml:2:10: region must be [[x0, x1], [y0, y1], [z0, z1]], voxels, x0 inclusive, x1 exclusive");
  EXPECT_EQ(message("[volume]\nregion = [[0, 8], [8, 8], [0, 8]]"),
            "s.toml:2:19: region has 8 to 8; it must be whole voxels, the first below the second");
  EXPECT_EQ(message("[volume]\nregion = [[0.5, 8], [0, 8], [0, 8]]"),
            "s.toml:2:11: region has 0.5 to 8; it must be whole voxels, the first below the second");
}

}  // namespace
}  // namespace weir::scene_test
