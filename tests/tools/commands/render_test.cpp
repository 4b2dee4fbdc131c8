// Tests weir render from outside: pictures, exit codes, messages, and what a failure leaves behind; also the majorants
// of a file that weir wrote.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "format/nanovdb/nvdb_file.h"
#include "gpu/image/png_input.h"
#include "gpu/render/cpu_renderer.h"
#include "gpu/render/render_scene.h"
#include "tests/support/run_command.h"

namespace weir::render_test {
namespace {

class Render : public ::testing::Test {
 protected:
  Render() {
    EXPECT_EQ(run_weir({"sample", "cloud", "-o", directory_ / "c_70x60x50_float32.raw"}).exit_code, 0);
    const CommandResult converted =
        run_weir({"convert", directory_ / "c_70x60x50_float32.raw", "--lossless", "-o", volume_});
    EXPECT_EQ(converted.exit_code, 0) << converted.err;
    std::filesystem::create_directory(out_);
  }

  std::vector<std::string> arguments(const std::string& image, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"render", volume_, "-o", out_ + "/" + image, "--overwrite", "--size",
                                 "40x30",  "--spp", "2"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  void expect_refused(const std::vector<std::string>& all, int exit_code, const std::string& line) {
    const CommandResult result = run_weir(all);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(result.err, "weir: " + line + "\n");
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(list_directory(out_).empty());
  }

  TemporaryDirectory directory_;
  std::string volume_ = directory_ / "c.nvdb";
  std::string out_ = directory_ / "out";
};

TEST_F(Render, EveryModeAndFormat) {
  for (const std::string mode : {"path", "dvr", "iso", "mip"}) {
    for (const std::string extension : {".png", ".exr"}) {
      const CommandResult result = run_weir(arguments(mode + extension, {"--mode", mode}));
      EXPECT_EQ(result.exit_code, 0) << result.err;
      EXPECT_EQ(result.out, "");
    }
  }
  EXPECT_EQ(list_directory(out_), (std::vector<std::string>{"dvr.exr", "dvr.png", "iso.exr", "iso.png", "mip.exr",
                                                            "mip.png", "path.exr", "path.png"}));
}

TEST_F(Render, SameBytesForAnyThreadsAndOtherForAnotherSeed) {
  const auto bytes = [&](const std::vector<std::string>& more) {
    EXPECT_EQ(run_weir(arguments("a.exr", more)).exit_code, 0);
    return read_file(out_ + "/a.exr");
  };
  const std::string one = bytes({"--threads", "1", "--seed", "5"});
  EXPECT_EQ(one, bytes({"--threads", "2", "--seed", "5", "--backend", "cpu"}));
  EXPECT_EQ(one, bytes({"--threads", "7", "--seed", "5", "--progress", "always"}));
  EXPECT_NE(one, bytes({"--seed", "6"}));
}

// If the root names an infinity, colours and warnings use the certificate's range.
TEST_F(Render, KeptInfinity_LeavesTheRangeOfTheOtherValues) {
  std::vector<float> values(20 * 20 * 20);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 1000.0F + static_cast<float>(i % 20);
  values[20 * 20 * 10] = 5000;
  values[20 * 20 * 10 + 1] = std::numeric_limits<float>::infinity();
  const auto* const bytes = reinterpret_cast<const char*>(values.data());
  write_file(directory_ / "i_20x20x20_float32.raw", {bytes, values.size() * sizeof(float)});
  const CommandResult converted = run_weir({"convert", directory_ / "i_20x20x20_float32.raw", "--lossless",
                                            "--nonfinite", "keep", "-o", directory_ / "i.nvdb"});
  ASSERT_EQ(converted.exit_code, 0) << converted.err;
  const auto picture = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{
        "render", directory_ / "i.nvdb", "-o",  out_ + "/i.png", "--overwrite", "--size", "40x30", "--spp",
        "2",      "--backend",           "cpu", "--mode"};
    all.insert(all.end(), more.begin(), more.end());
    const CommandResult result = run_weir(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err.find("the picture shows no surface"), std::string::npos) << result.err;
    return read_file(out_ + "/i.png");
  };
  EXPECT_EQ(picture({"dvr"}), picture({"dvr", "--range", "1000,5000"}));
  EXPECT_NE(picture({"dvr"}), picture({"dvr", "--range", "1000,1019"}));
  picture({"iso", "--iso", "4500"});
}

TEST_F(Render, Json) {
  const CommandResult result = run_weir(arguments("a.png", {"--json", "--mode", "mip", "--filter", "nearest"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto report = nlohmann::json::parse(result.out);
  EXPECT_EQ(report["image"], out_ + "/a.png");
  EXPECT_EQ(report["width"], 40);
  EXPECT_EQ(report["height"], 30);
  EXPECT_EQ(report["mode"], "mip");
  EXPECT_EQ(report["filter"], "nearest");
  EXPECT_EQ(report["backend"], "cpu");
  EXPECT_EQ(report["samples"], 2);
  EXPECT_EQ(report["bytes"], read_file(out_ + "/a.png").size());
}

TEST_F(Render, CommandLineOverridesTheSceneFile) {
  write_file(directory_ / "s.toml", "mode = \"dvr\"\n[volume]\ncolormap = \"heat\"\n");
  const auto mode = [&](const std::vector<std::string>& more) {
    const CommandResult result = run_weir(arguments("a.png", more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out)["mode"];
  };
  const std::string scene = directory_ / "s.toml";
  EXPECT_EQ(mode({"--json", "--scene", scene}), "dvr");
  EXPECT_EQ(mode({"--json", "--scene", scene, "--mode", "iso", "--iso", "0.25", "--camera", "10,-90,2", "--colormap",
                  "gray"}),
            "iso");
}

TEST_F(Render, IsoValueWithoutAMode_DrawsTheSurface) {
  const CommandResult result = run_weir(arguments("a.png", {"--json", "--iso", "0.25"}));
  EXPECT_EQ(nlohmann::json::parse(result.out)["mode"], "iso");
  EXPECT_EQ(result.err, "");
  const CommandResult outside = run_weir(arguments("b.png", {"--iso", "7"}));
  EXPECT_EQ(outside.exit_code, 0);
  EXPECT_NE(outside.err.find("warning the iso value 7 lies outside the values, 0 .. "), std::string::npos)
      << outside.err;
  EXPECT_NE(outside.err.find(": the picture shows no surface\n"), std::string::npos) << outside.err;
}

TEST_F(Render, ColorBar_StandsRightOfThePictureThatIsAsWithoutIt) {
  const auto rendered = [&](const std::string& image, const std::vector<std::string>& more) {
    std::vector<std::string> all{"render", volume_, "-o",         out_ + "/" + image, "--size", "40x80",
                                 "--mode", "mip",   "--colormap", "viridis",          "--json"};
    all.insert(all.end(), more.begin(), more.end());
    const CommandResult result = run_weir(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  };
  EXPECT_EQ(rendered("a.png", {})["colorbar_width"], 0);
  const nlohmann::json report = rendered("b.png", {"--colorbar"});
  const Image plain = read_png(out_ + "/a.png");
  const Image both = read_png(out_ + "/b.png");
  EXPECT_EQ(report["width"], both.width);
  EXPECT_EQ(report["colorbar_width"], both.width - 40);
  ASSERT_GT(both.width, 56);
  for (std::int32_t y = 0; y < 80; ++y) {
    for (std::int32_t x = 0; x < 40; ++x) ASSERT_EQ(both.at(x, y), plain.at(x, y));
  }
  EXPECT_EQ(both.at(41, 40), (Float3{1, 1, 1}));
}

TEST_F(Render, OptionsOfADeviceWithoutOne_AreSaidToHaveNoEffect) {
  const CommandResult by_device = run_weir(arguments("c.png", {"--backend", "cuda"}));
  if (by_device.exit_code == 0) GTEST_SKIP() << "there is a device";
  const std::string no_renderer = "this build has no CUDA renderer";
  const std::string why = by_device.err.find(no_renderer) == std::string::npos ? "no CUDA device answers" : no_renderer;
  const CommandResult drawn = run_weir(arguments("a.png", {"--device-memory", "1GiB"}));
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_NE(drawn.err.find(why + ": the CPU draws, and --devices and --device-memory have no effect"),
            std::string::npos)
      << drawn.err;
  const CommandResult chosen = run_weir(arguments("d.png", {"--backend", "cpu", "--device-memory", "1GiB"}));
  EXPECT_NE(chosen.err.find("--backend cpu was chosen, and --devices and --device-memory have no effect"),
            std::string::npos)
      << chosen.err;
  EXPECT_EQ(run_weir(arguments("b.png")).err.find("have no effect"), std::string::npos);
}

TEST_F(Render, Refusals) {
#ifndef WEIR_HAVE_CUDA
  expect_refused(arguments("a.png", {"--backend", "cuda"}), 2,
                 "--backend cuda: this build has no CUDA renderer; use --backend cpu or auto");
#endif
  for (const std::string devices : {"0,0", "-1", "x"}) {
    expect_refused(arguments("a.png", {"--devices=" + devices}), 2,
                   "--devices is \"" + devices + "\", it must be numbers of CUDA devices, each once");
  }
  expect_refused(arguments("a.exr", {"--colorbar"}), 2,
                 out_ +
                     "/a.exr: holds radiance, and --colorbar colours as a screen shows them; choose a name that ends "
                     "in .png");
  expect_refused(arguments("a.png", {"--colorbar"}), 2,
                 "--colorbar needs a picture of at least 64 pixels in height, this one has 30");
  for (const std::vector<std::string>& surface : {std::vector<std::string>{"--mode", "iso"}, {"--iso", "0.25"}}) {
    expect_refused(arguments("a.png", {"--colorbar", surface[0], surface[1]}), 2,
                   "--colorbar says which colour is which value, and --mode iso draws the surface of one; leave one of "
                   "them out");
  }
  expect_refused(arguments("no/a.png"), 5,
                 out_ + "/no/a.png: the directory " + out_ + "/no does not exist; make it or choose another output");
  expect_refused(arguments("a.jpg"), 2, "-o " + out_ + "/a.jpg: an image's name must end in .png or .exr");
  expect_refused(
      arguments("a.png", {"--colormap", "jet"}), 2,
      "--colormap is \"jet\", it must be gray, white, heat, cool-warm, dusk, ct, water, magma, viridis, plasma, "
      "inferno or cividis");
  expect_refused(
      arguments("a.png", {"--camera", "1"}), 2,
      "--camera is \"1\", it must be AZIMUTH,ELEVATION[,ZOOM] in degrees, elevation from -90 to 90, zoom from "
      "0.01 to 100");
  expect_refused(arguments("a.png", {"--iso", "high"}), 2, "--iso is \"high\", it must be a number");
  expect_refused(arguments("a.png", {"--mode", "dvr", "--iso", "1"}), 2,
                 "--iso is of the surface that --mode iso draws; not --mode dvr");
  expect_refused(arguments("a.png", {"--threads", "-1"}), 2,
                 "--threads is \"-1\", it must be a whole number from 0 to 4096");
  for (const std::string memory : {"0", "-1", "much"}) {
    for (const std::string option : {"--memory", "--device-memory"}) {
      expect_refused(arguments("a.png", {option + "=" + memory}), 2,
                     option + " is \"" + memory + "\", it must be a size above 0, like 512MiB");
    }
  }
  for (const std::string level : {"on", "16", "nan"}) {
    expect_refused(arguments("a.png", {"--lod", level}), 2,
                   "--lod is \"" + level + "\", it must be auto, off, or a number of levels from -15 to 15");
  }
  expect_refused(arguments("a.png", {"--lod", "auto", "--lod-scattered", "-1"}), 2,
                 "--lod-scattered is \"-1\", it must be a number of levels from 0 to 15");
  for (const std::string level : {"", "off"}) {
    std::vector<std::string> options{"--lod-scattered", "2"};
    if (!level.empty()) options.insert(options.end(), {"--lod", level});
    expect_refused(arguments("a.png", options), 2, "--lod-scattered needs --lod auto or a number of levels");
  }
  expect_refused(arguments("a.png", {"--mode", "dvr", "--lod", "auto", "--lod-scattered", "2"}), 2,
                 "--lod-scattered is of the light that --mode path scatters; not --mode dvr");
  expect_refused(arguments("a.png", {"--seed", "1.5"}), 2,
                 "--seed is \"1.5\", it must be a whole number from 0 to 9223372036854775807");
  for (const std::string size : {"640", "0x480", "640x-1", "axb", "640x480x2", "99999x1", "32768x32768"}) {
    expect_refused({"render", volume_, "-o", out_ + "/a.png", "--size", size}, 2,
                   "--size is \"" + size + "\", it must be WxH in pixels, each from 1 to 32768 and 268435456 together");
  }
  expect_refused({"render", volume_, "-o", out_ + "/a.png", "--spp", "0"}, 2,
                 "--spp is \"0\", it must be a whole number from 1 to 1048576");
  write_file(directory_ / "s.toml", "[camera]\nfocal = 3\n");
  expect_refused(arguments("a.png", {"--scene", directory_ / "s.toml"}), 3,
                 (directory_ / "s.toml") +
                     ":2:1: unknown key \"focal\" in [camera]; there are azimuth, elevation, fov, frame, look_at, "
                     "position, up, zoom");
}

TEST_F(Render, EnvironmentOfTheSceneChangesThePicture) {
  const std::string scene = directory_ / "s.toml";
  write_file(scene, "[lighting]\nenvironment = \"sky.hdr\"\nbackground = \"environment\"\n");
  const std::string sky = directory_ / "sky.hdr";
  write_file(sky, "#?RADIANCE\n\n-Y 1 +X 2\n\x80\x40\x20\x81\x20\x40\x80\x81");
  EXPECT_EQ(run_weir(arguments("a.exr", {"--scene", scene})).exit_code, 0);
  EXPECT_EQ(run_weir(arguments("b.exr")).exit_code, 0);
  EXPECT_FALSE(read_file(out_ + "/a.exr") == read_file(out_ + "/b.exr"));
  std::filesystem::remove(out_ + "/a.exr");
  std::filesystem::remove(out_ + "/b.exr");
  write_file(sky, "#?RADIANCE\n\n-Y 1 +X 3\n");
  expect_refused(arguments("a.png", {"--scene", scene}), 3,
                 sky + ": 3 x 1 pixels; a latitude-longitude picture is twice as wide as high");
  std::filesystem::remove(sky);
  const CommandResult missing = run_weir(arguments("a.png", {"--scene", scene}));
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_EQ(missing.err, "weir: " + sky +
                             ": cannot open: No such file or directory; the scene's [lighting] environment names "
                             "it\n");
}

TEST_F(Render, UnwritableOutput_IsRefusedBeforeRendering) {
  const CommandResult result = run_weir({"render", volume_, "-o", directory_ / "missing/a.png", "--spp", "1000000"});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_NE(result.err.find("missing"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find('\n'), result.err.size() - 1);
}

TEST_F(Render, ExistingPicture_IsReplacedWithOverwriteOnly) {
  const std::string picture = directory_ / "a.png";
  write_file(picture, "precious");
  expect_refused({"render", volume_, "-o", picture, "--spp", "1000000"}, 2,
                 picture + ": exists; choose another output or pass --overwrite");
  EXPECT_EQ(read_file(picture), "precious");
  EXPECT_EQ(run_weir({"render", volume_, "-o", picture, "--size", "8x6", "--spp", "1", "--overwrite"}).exit_code, 0);
  EXPECT_EQ(read_file(picture).substr(1, 3), "PNG");
}

TEST_F(Render, MoreThreadsThanProcessors_AreTakenWithoutAWord) {
  EXPECT_EQ(run_weir({"render", volume_, "-o", out_ + "/a.png", "--size", "8x6", "-q", "--threads", "7"}).err, "");
}

TEST_F(Render, MissingOrForeignInput) {
  EXPECT_EQ(run_weir({"render", directory_ / "no.nvdb", "-o", out_ + "/a.png"}).exit_code, 3);
  const std::string raw = directory_ / "c_70x60x50_float32.raw";
  const CommandResult foreign = run_weir({"render", raw, "-o", out_ + "/a.png"});
  EXPECT_EQ(foreign.exit_code, 3);
  EXPECT_EQ(foreign.err, "weir: " + raw + ": is no NanoVDB file; convert it first: weir convert " + raw +
                             ", or draw its own values with --volume dense\n");
  EXPECT_TRUE(list_directory(out_).empty());
}

TEST_F(Render, InterruptLeavesNothing) {
  for (const int signal : {SIGINT, SIGTERM}) {
    ChildProcess child({WEIR_COMMAND, "render", volume_, "-o", out_ + "/a.png", "--spp", "100000"});
    for (int i = 0; i < 500 && list_directory(out_).empty(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_EQ(list_directory(out_).size(), 1U) << "the temporary file of a running rendering";
    child.send_signal(signal);
    const CommandResult result = child.wait();
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_EQ(result.err, "weir: interrupted; no image was written\n");
    EXPECT_TRUE(list_directory(out_).empty());
  }
}

// Whole numbers are exact in 8 bits, so a quantised file gives the same picture, with equal macrocells and look-ups.
TEST_F(Render, QuantisedFilesOfTheSameValuesGiveTheSamePicture) {
  const std::string raw = directory_ / "c_70x60x50_uint8.raw";
  ASSERT_EQ(run_weir({"sample", "cloud", "-o", raw}).exit_code, 0);
  const auto image = [&](const std::string& mode, const std::string& filter) {
    EXPECT_EQ(run_weir(arguments("a.exr", {"--mode", mode, "--filter", filter})).exit_code, 0);
    return read_file(out_ + "/a.exr");
  };
  std::map<std::pair<std::string, std::string>, std::string> expected;
  for (const std::string encoding : {"float", "fpn", "fp8", "fp16"}) {
    const CommandResult converted =
        run_weir({"convert", raw, "--lossless", "--encoding", encoding, "-o", volume_, "--overwrite"});
    ASSERT_EQ(converted.exit_code, 0) << converted.err;
    for (const std::string mode : {"path", "dvr", "iso", "mip"}) {
      for (const std::string filter : {"trilinear", "stochastic", "nearest"}) {
        std::string& of_float = expected[{mode, filter}];
        if (encoding == "float") of_float = image(mode, filter);
        EXPECT_TRUE(image(mode, filter) == of_float) << encoding << ' ' << mode << ' ' << filter;
      }
    }
  }
}

TEST_F(Render, QuantisedFilesAtAHighRateGiveNearlyThePicture) {
  const auto picture = [&](RenderMode mode) {
    const NvdbFile file(volume_);
    Scene scene;
    scene.mode = mode;
    const RenderScene prepared(file.grid(), scene, {.width = 60, .height = 45});
    CpuRenderOptions options;
    options.samples = 2;
    return render_cpu(prepared.task(), options);
  };
  for (const RenderMode mode : {RenderMode::dvr, RenderMode::mip}) {
    ASSERT_EQ(run_weir({"convert", directory_ / "c_70x60x50_float32.raw", "--lossless", "-o", volume_, "--overwrite"})
                  .exit_code,
              0);
    const Image exact = picture(mode);
    ASSERT_EQ(run_weir({"convert", directory_ / "c_70x60x50_float32.raw", "--rate", "1.6", "--encoding", "fpn", "-o",
                        volume_, "--overwrite"})
                  .exit_code,
              0);
    const Image near = picture(mode);
    float worst = 0;
    for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
      const Float3 d = exact.pixels[i] - near.pixels[i];
      worst = std::max({worst, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
    }
    EXPECT_GT(worst, 0.0F);
    EXPECT_LT(worst, 0.004F);  // one step of an 8-bit picture
  }
}

// The file's macrocells bound what any filter reads in them, in tiles and in kept leaves.
TEST_F(Render, MajorantsFromTheFileBoundEveryLookup) {
  for (const std::string rate : {"1.2", "1.7", "2.5"}) {
    ASSERT_EQ(run_weir({"convert", directory_ / "c_70x60x50_float32.raw", "--rate", rate, "-o", volume_, "--overwrite"})
                  .exit_code,
              0);
    const NvdbFile file(volume_);
    ASSERT_FALSE(file.grid().macrocells().cells.empty());
    for (const Filter filter : {Filter::nearest, Filter::trilinear, Filter::stochastic}) {
      const RenderScene prepared(file.grid(), {}, {.filter = filter});
      const auto& medium = prepared.task().medium;
      Random random(1, 2, 3);
      for (int i = 0; i < 200000; ++i) {
        const Float3 p = medium.volume.extent() * Float3{random.uniform(), random.uniform(), random.uniform()};
        const auto cell = [&](float at, std::int32_t shift) {
          return static_cast<std::int64_t>((at + static_cast<float>(shift)) / medium.cells.edge);
        };
        const std::int64_t c = cell(p.x, medium.cells.shift.x) +
                               medium.cells.count.x * (cell(p.y, medium.cells.shift.y) +
                                                       medium.cells.count.y * cell(p.z, medium.cells.shift.z));
        const float opacity = medium.transfer.at(medium.volume.sample(p, random)).a;
        ASSERT_LE(medium.extinction(opacity), medium.majorant(c));
      }
    }
  }
}

}  // namespace
}  // namespace weir::render_test
