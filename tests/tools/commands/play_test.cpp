// Tests weir play from outside: frames are those of weir render, in order, complete or absent.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/run_command.h"

namespace weir::play_test {
namespace {

class Play : public ::testing::Test {
 protected:
  /// Makes a lossless file of `kind`; each `seed` gives another volume.
  std::string make(const std::string& name, const std::string& kind, int seed,
                   const std::string& shape = "40x36x32") const {
    const std::string raw = directory_ / (kind + "_" + shape + "_float32.raw");
    EXPECT_EQ(run_weir({"sample", kind, "-o", raw, "--overwrite", "--seed", std::to_string(seed)}).exit_code, 0);
    EXPECT_EQ(run_weir({"convert", raw, "--lossless", "-o", directory_ / name}).exit_code, 0);
    return directory_ / name;
  }
  std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) const {
    arguments.insert(arguments.end(), look_.begin(), look_.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  std::string frame(const std::string& name) const { return read_file(out_ + "/" + name); }
  /// Returns the picture of one step, rendered with the look of the series.
  std::string rendered(const std::string& volume, const std::string& range) const {
    write_file(directory_ / "fixed.toml", "[camera]\nframe = \"volume\"\n");
    const std::string image = directory_ / "one.png";
    const CommandResult result = run_weir(with(
        {"render", volume, "-o", image, "--overwrite", "--scene", directory_ / "fixed.toml", "--range", range}, {}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_file(image);
  }
  void expect_refused(const std::vector<std::string>& arguments, int exit_code, const std::string& line) const {
    const CommandResult result = run_weir(arguments);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(result.err, "weir: " + line + "\n");
    EXPECT_EQ(result.out, "");
  }

  TemporaryDirectory directory_;
  std::string out_ = directory_ / "out";
  std::vector<std::string> look_{"--size", "40x30", "--spp", "2", "--seed", "3"};
};

TEST_F(Play, FramesAreThoseOfRenderInNaturalOrder) {
  std::vector<std::string> steps;
  for (const int step : {1, 2, 10}) steps.push_back(make("s_" + std::to_string(step) + ".nvdb", "signed", step));
  const CommandResult result = run_weir(with({"play", directory_ / "s_*.nvdb", "-o", out_, "--json"}, {}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(list_directory(out_), (std::vector<std::string>{"frame_00000.png", "frame_00001.png", "frame_00002.png"}));
  const auto report = nlohmann::json::parse(result.out);
  const std::string range = report["range"][0].dump() + "," + report["range"][1].dump();
  EXPECT_TRUE(frame("frame_00000.png") == rendered(steps[0], range));
  EXPECT_TRUE(frame("frame_00001.png") == rendered(steps[1], range));
  EXPECT_TRUE(frame("frame_00002.png") == rendered(steps[2], range));
  EXPECT_FALSE(frame("frame_00000.png") == frame("frame_00001.png"));
  EXPECT_EQ(report["output"], out_);
  EXPECT_EQ(report["frames"], 3);
  EXPECT_EQ(report["width"], 40);
  EXPECT_EQ(report["height"], 30);
  EXPECT_EQ(report["mode"], "path");
  EXPECT_EQ(report["backend"], "cpu");
  EXPECT_EQ(report["samples"], 2);
  EXPECT_EQ(report["load"]["way"], "mapped");
  EXPECT_GT(report["steps_per_s"], 0.0);
  EXPECT_GE(report["total_s"], report["render_s"]);
  double most = 0;
  for (const std::string stage : {"load", "render", "write"}) most = std::max<double>(most, report[stage + "_s"]);
  EXPECT_EQ(report[report["limit"].get<std::string>() + "_s"], most);
}

TEST_F(Play, RawWritesTheRgbBytesOfEveryFrame) {
  make("s_1.nvdb", "noise", 1);
  make("s_2.nvdb", "noise", 2);
  const CommandResult raw = run_weir(with({"play", directory_ / "s_*.nvdb", "--raw", "-"}, {"--mode", "mip"}));
  ASSERT_EQ(raw.exit_code, 0) << raw.err;
  EXPECT_EQ(raw.out.size(), 2U * 40 * 30 * 3);
  EXPECT_FALSE(raw.out.substr(0, 3600) == raw.out.substr(3600));
  // One gray all over has the same three bytes all over.
  const std::string constant = make("c.nvdb", "constant", 1);
  const CommandResult gray =
      run_weir(with({"play", constant, "--raw", "-", "--range", "0,1"}, {"--mode", "mip", "--camera", "0,0,100"}));
  ASSERT_EQ(gray.exit_code, 0) << gray.err;
  ASSERT_EQ(gray.out.size(), 3600U);
  EXPECT_EQ(gray.out, std::string(3600, gray.out[0]));
}

// The range is the union of all ranges, so that a value has one colour in all frames; a range in the scene takes
// precedence.
TEST_F(Play, RangeIsTakenFromTheWholeSeriesUnlessGiven) {
  const std::string ramp = make("a.nvdb", "gradient", 1);
  const std::string half = make("b.nvdb", "constant", 1);
  const auto range = [&](const std::vector<std::string>& more) {
    const CommandResult result = run_weir(with({"play", ramp, half, "-o", out_, "--json"}, more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out)["range"];
  };
  EXPECT_EQ(range({}), nlohmann::json({0.0, 1.0}));
  EXPECT_EQ(range({"--range", "-2,0.5"}), nlohmann::json({-2.0, 0.5}));
  write_file(directory_ / "s.toml", "[volume]\nrange = [3, 4]\n");
  EXPECT_EQ(range({"--scene", directory_ / "s.toml"}), nlohmann::json({3.0, 4.0}));
}

TEST_F(Play, StepsOfDifferentSizes_GiveAWarning) {
  const std::string small = make("a.nvdb", "noise", 1, "16x16x16");
  const std::string large = make("b.nvdb", "noise", 1, "24x16x16");
  const CommandResult result = run_weir(with({"play", small, large, "-o", out_}, {}));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("warning " + small + " has 16 x 16 x 16 voxels from 0,0,0, " + large +
                            " has 24 x 16 x 16 voxels from 0,0,0; the camera frames each step's own box\n"),
            std::string::npos)
      << result.err;
  EXPECT_EQ(list_directory(out_).size(), 2U);
}

// Both volumes are seen through 16 voxels; the first has no longer direction, the second extends to 64.
TEST_F(Play, StepsOfDifferentSizes_HaveOneExtinction) {
  const std::string first = make("a.nvdb", "constant", 1, "16x16x16");
  const std::string second = make("b.nvdb", "constant", 1, "16x16x64");
  write_file(directory_ / "s.toml",
             "mode = \"dvr\"\n"
             "[camera]\nposition = [-30, 8, 8]\nlook_at = [8, 8, 8]\nfov = 2\n"
             "[volume]\nrange = [0, 1]\nopacity = [[0, 0], [1, 1]]\ndensity = 2\nshading = 0\ncolormap = \"white\"\n"
             "[lighting]\nbackground = [0, 0, 0]\nexposure = 1\n");
  const CommandResult result = run_weir({"play", first, second, "--raw", "-", "--size", "8x8", "--spp", "4", "--scene",
                                         directory_ / "s.toml", "--log-level", "error"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::size_t frame = std::size_t{8} * 8 * 3;
  ASSERT_EQ(result.out.size(), 2 * frame);
  EXPECT_EQ(result.out.substr(0, frame), result.out.substr(frame));
  // 1 - exp(-1) in sRGB, except for the offset at which the samples begin.
  EXPECT_NEAR(static_cast<unsigned char>(result.out[(4 * 8 + 4) * 3]), 207, 4);
}

TEST_F(Play, StepThatNamesNoRange_GivesAWarning) {
  const std::string half = make("a.nvdb", "constant", 1, "9x8x7");
  const std::string raw = directory_ / "holes_9x8x7_float32.raw";
  const std::string holes = directory_ / "b.nvdb";
  ASSERT_EQ(run_weir({"sample", "some-nan", "-o", raw}).exit_code, 0);
  ASSERT_EQ(run_weir({"convert", raw, "--lossless", "--nonfinite", "keep", "-o", holes}).exit_code, 0);
  const auto said = [&](const std::vector<std::string>& inputs, const std::vector<std::string>& more) {
    std::vector<std::string> all{"play"};
    all.insert(all.end(), inputs.begin(), inputs.end());
    all.insert(all.end(), {"-o", out_});
    const CommandResult result = run_weir(with(all, more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err;
  };
  const std::string none = " names no finite range of its values, and has no certificate that does; ";
  EXPECT_EQ(said({half, holes}, {}).find(none), std::string::npos) << "the certificate has one";
  std::filesystem::remove(holes + ".json");
  const std::string without = said({half, holes}, {});
  EXPECT_NE(without.find("warning " + holes + ":" + none +
                         "the colours of all frames are made without it; give --range LOW,HIGH\n"),
            std::string::npos)
      << without;
  const std::string alone = said({holes}, {});
  EXPECT_NE(alone.find("each frame has colours of its own; give --range LOW,HIGH\n"), std::string::npos) << alone;
  EXPECT_EQ(said({half, holes}, {"--range", "0,1"}).find(none), std::string::npos);
}

TEST_F(Play, FramesLeftByALongerSeries_GiveAWarning) {
  const std::string volume = make("a.nvdb", "noise", 1);
  std::filesystem::create_directory(out_);
  write_file(out_ + "/frame_00001.png", "old");
  const CommandResult result = run_weir(with({"play", volume, "-o", out_}, {}));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("warning " + out_ + "/frame_00001.png: is from a longer series; this one ends before it\n"),
            std::string::npos)
      << result.err;
  EXPECT_EQ(frame("frame_00001.png"), "old");
  const CommandResult failed = run_weir(with({"play", volume + ".none", "-o", out_}, {}));
  EXPECT_EQ(failed.exit_code, 3);
  EXPECT_EQ(failed.err.find("longer series"), std::string::npos) << failed.err;
}

TEST_F(Play, BrokenFile_EndsPlayAfterTheFramesBefore) {
  make("s_1.nvdb", "noise", 1);
  make("s_2.nvdb", "noise", 2);
  const std::string broken = directory_ / "s_3.nvdb";
  write_file(broken, read_file(directory_ / "s_1.nvdb").substr(0, 5000));
  make("s_4.nvdb", "noise", 4);
  const std::string reason = run_weir({"render", broken, "-o", directory_ / "x.png"}).err;
  EXPECT_NE(reason.find(broken), std::string::npos);
  const CommandResult result = run_weir(with({"play", directory_ / "s_*.nvdb", "-o", out_}, {}));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err, reason);
  EXPECT_EQ(list_directory(out_), (std::vector<std::string>{"frame_00000.png", "frame_00001.png"}));
  const CommandResult missing =
      run_weir(with({"play", directory_ / "s_1.nvdb", directory_ / "s_9.nvdb", "-o", out_}, {}));
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_EQ(missing.err, run_weir({"render", directory_ / "s_9.nvdb", "-o", directory_ / "x.png"}).err);
}

TEST_F(Play, IsoValueOutsideAllSteps_IsWarnedOf) {
  const std::string one = make("s_1.nvdb", "sphere", 1);
  const CommandResult result = run_weir({"play", one, "-o", out_, "--size", "8x8", "--spp", "1", "--iso", "9"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find(" warning the iso value 9 lies outside the values, 0 .. "), std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find(": the picture shows no surface\n"), std::string::npos) << result.err;
}

TEST_F(Play, Refusals) {
  const std::string volume = make("a.nvdb", "noise", 1);
  expect_refused({"play", volume}, 2, "give one of -o DIR and --raw -");
  expect_refused({"play", volume, "-o", out_, "--raw", "-"}, 2, "give one of -o DIR and --raw -");
  expect_refused({"play", volume, "--raw", "a.rgb"}, 2,
                 "--raw is \"a.rgb\", it must be -, frames on stdout; redirect it to a file");
  expect_refused({"play", volume, "--raw", "-", "--json"}, 2,
                 "--json and --raw - both take stdout; leave one of them out");
  expect_refused({"play", volume, "-o", out_, "--range", "1,0"}, 2,
                 "--range is \"1,0\", it must be LOW,HIGH, two numbers that do not fall");
  expect_refused({"play", directory_ / "n*.nvdb", "-o", out_}, 3,
                 (directory_ / "n*.nvdb") + ": no file has such a name; give files, or a pattern in quotes");
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(Play, Interrupt_LeavesOnlyCompleteFrames) {
  std::vector<std::string> arguments{WEIR_COMMAND, "play"};
  for (int step = 0; step < 4; ++step) arguments.push_back(make("s_" + std::to_string(step) + ".nvdb", "cloud", step));
  arguments.insert(arguments.end(), {"-o", out_, "--size", "40x30", "--spp", "300", "--progress", "never"});
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove_all(out_);
    ChildProcess child(arguments);
    for (int i = 0; i < 3000 && !std::filesystem::exists(out_ + "/frame_00000.png"); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    child.send_signal(signal);
    const CommandResult result = child.wait();
    EXPECT_EQ(result.exit_code, 130);
    const std::vector<std::string> left = list_directory(out_);
    EXPECT_EQ(result.err, "weir: interrupted; " + std::to_string(left.size()) + " of 4 frames were written\n");
    EXPECT_GE(left.size(), 1U);
    EXPECT_LT(left.size(), 4U);
    for (const std::string& name : left) EXPECT_EQ(name.substr(0, 6), "frame_") << "no partial files";
  }
}

// An encoder that goes away ends weir play with exit code and message of an I/O failure.
TEST_F(Play, AClosedPipeIsAnError) {
  make("s_1.nvdb", "noise", 1);
  make("s_2.nvdb", "noise", 2);
  ChildProcess child({"bash", "-c",
                      std::string("set -o pipefail; ") + WEIR_COMMAND + " play '" + (directory_ / "s_*.nvdb") +
                          "' --raw - --size 400x300 --mode mip --spp 1 | head -c 10 > /dev/null"});
  const CommandResult result = child.wait();
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(result.err, "weir: stdout: cannot write: Broken pipe\n");
}

}  // namespace
}  // namespace weir::play_test
