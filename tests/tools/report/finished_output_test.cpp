// Tests what `weir convert --skip-done` leaves alone, makes anew and refuses.
#include "tools/report/finished_output.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "compressor/resume/journal.h"
#include "format/io/file_system.h"
#include "tests/support/python.h"
#include "tests/support/run_command.h"
#include "tests/support/unreadable_file.h"

namespace weir::finished_output_test {
namespace {

namespace fs = std::filesystem;

class SkipDone : public testing::Test {
 protected:
  SkipDone() { write_source('\3'); }

  void write_source(char seed) const {
    std::string bytes(40 * 32 * 24, '\0');
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * static_cast<unsigned char>(seed));
    write_file(source_, bytes);
  }

  CommandResult convert(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"convert", source_, "-o", output_, "--skip-done", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_weir(arguments);
  }

  /// Returns whether the run left the existing file in place.
  bool leaves_it(const std::vector<std::string>& more = {}) const {
    const auto before = fs::last_write_time(output_);
    const CommandResult result = convert(more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const bool left = fs::last_write_time(output_) == before;
    EXPECT_EQ(left, result.err.find("done already") != std::string::npos) << result.err;
    EXPECT_EQ(result.out, read_file(output_ + ".json"));
    EXPECT_EQ(run_weir({"verify", output_}).exit_code, 0);
    EXPECT_EQ(list_directory(directory_.path()).size(), 3U);
    return left;
  }

  TemporaryDirectory directory_;
  std::string source_ = directory_ / "v_40x32x24_uint8.raw";
  std::string output_ = directory_ / "v.nvdb";
};

TEST_F(SkipDone, FinishedOutput_IsSkippedAndReportedTheSame) {
  const CommandResult first = convert();
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_TRUE(leaves_it());
  EXPECT_TRUE(leaves_it({"--memory", "256MiB", "--threads", "1", "--overwrite"})) << "the bytes would be the same";
}

TEST_F(SkipDone, OneFileWithAnotherPath_IsTheSameSource) {
  ASSERT_EQ(convert().exit_code, 0);
  source_ = directory_ / "./v_40x32x24_uint8.raw";
  EXPECT_TRUE(leaves_it());
}

TEST_F(SkipDone, EqualOptionsWrittenOtherwise_AreSkipped) {
  const auto expect_equal = [&](const std::vector<std::string>& first, const std::vector<std::string>& second) {
    ASSERT_EQ(convert(first).exit_code, 0);
    EXPECT_TRUE(leaves_it(second)) << second.front();
  };
  expect_equal({"--size", "512KiB"}, {"--size", "524288"});
  expect_equal({"--rate", "0.3"}, {"--rate", "0.30"});
  expect_equal({"--psnr", "50"}, {"--psnr=5e1", "--encoding", "auto", "--fill", "mean", "--background", "auto"});
  expect_equal({"--origin", "1,2,3", "--type", "uint8"}, {"--origin", "1.0,2,3e0", "--type", "u1"});
  EXPECT_FALSE(leaves_it({"--origin", "1,2,3.0000001"}));
}

TEST_F(SkipDone, OptionsThatSayWhatIsMeantWithoutThem_AreSkipped) {
  ASSERT_EQ(convert().exit_code, 0);
  for (const std::vector<std::string>& same : std::vector<std::vector<std::string>>{
           {"--quiet"},
           {"-q", "--missing-policy", "error"},
           {"--dims", "40,32,24"},
           {"--dims", "40x32x24", "--type", "uint8", "--endian", "little", "--offset", "0"},
           {"--spacing", "1,1,1", "--origin", "0,0,0"},
           {"--roi", "0:40,:,-24:"},
           {"--roi", "0:40,0:32,0:24"},
           {"--ghost", "0"}}) {
    const auto before = fs::last_write_time(output_);
    EXPECT_EQ(convert(same).exit_code, 0) << same.back();
    EXPECT_EQ(fs::last_write_time(output_), before) << same.back();
  }
  for (const std::vector<std::string>& other : std::vector<std::vector<std::string>>{
           {"--ghost", "1"}, {"--roi", "0:39,:,:"}, {"--roi", "1:40,:,:"}, {"--spacing", "1,1,2"}}) {
    EXPECT_FALSE(leaves_it(other)) << other.back();
  }
  const CommandResult whole = convert();
  EXPECT_NE(whole.err.find(": converted again: made of another region, or with another spacing or origin\n"),
            std::string::npos)
      << whole.err;
}

// Another spelling of the name, and a position that is named or counted from the end, mean the same volume.
TEST_F(SkipDone, TheSameDatasetAndPosition_AreSkippedHoweverTheyAreGiven) {
  if (!python_has("netCDF4, numpy")) GTEST_SKIP() << "python3 with netCDF4 is missing";
  ASSERT_TRUE(run_python(R"(
import sys, netCDF4
n = netCDF4.Dataset(sys.argv[1] + "/a.nc", "w")
for name, size in [("time", 4), ("z", 5), ("y", 6), ("x", 7)]: n.createDimension(name, size)
v = n.createVariable("a", "f4", ("time", "z", "y", "x"))
for t in range(4): v[t] = t
n.close()
)",
                         directory_.path().string()));
  source_ = directory_ / "a.nc";
  const auto made = [&](const std::vector<std::string>& options) {
    std::vector<std::string> command{"convert", source_, "-o", output_, "--skip-done"};
    command.insert(command.end(), options.begin(), options.end());
    const CommandResult result = run_weir(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err.find(": done already\n") == std::string::npos;
  };
  EXPECT_TRUE(made({"--dataset", "a", "--index", "3"}));
  EXPECT_FALSE(made({"--dataset", "/a", "--index", "3"}));
  EXPECT_FALSE(made({"--dataset", "/a", "--index", "-1"}));
  EXPECT_FALSE(made({"--dataset", "a", "--index", "time=3"}));
  EXPECT_FALSE(made({"--index", "3"}));
  EXPECT_TRUE(made({"--dataset", "a", "--index", "2"}));
}

TEST_F(SkipDone, ConvertsAgainWhatChanged) {
  ASSERT_EQ(convert().exit_code, 0);
  EXPECT_FALSE(leaves_it({"--size", "400000"})) << "an option";
  EXPECT_FALSE(leaves_it()) << "the option again";
  write_source('\5');
  EXPECT_FALSE(leaves_it()) << "the source";
  fs::last_write_time(source_, fs::last_write_time(source_) + std::chrono::nanoseconds(1));
  EXPECT_FALSE(leaves_it()) << "a nanosecond";
}

TEST_F(SkipDone, GradientThatTheSidecarLacks_IsCertified_AndOneThatItHasIsKept) {
  ASSERT_EQ(convert().exit_code, 0);
  const std::string volume = read_file(output_);
  const CommandResult again = convert({"--certify", "gradient"});
  EXPECT_NE(again.err.find(output_ + ": converted again: its sidecar does not certify the gradient\n"),
            std::string::npos)
      << again.err;
  const auto record = nlohmann::json::parse(again.out);
  EXPECT_EQ(record["error"]["gradient"]["voxels"], 40 * 32 * 24);
  EXPECT_EQ(read_file(output_), volume);
  EXPECT_TRUE(leaves_it({"--certify", "gradient"}));
  EXPECT_TRUE(leaves_it());
}

TEST_F(SkipDone, SourceReplacedWithTheSameSizeAndTime_IsConvertedAgain) {
  ASSERT_EQ(convert().exit_code, 0);
  const auto time = fs::last_write_time(source_);
  const std::string first = source_;
  source_ = directory_ / "other_40x32x24_uint8.raw";
  write_source('\5');
  fs::last_write_time(source_, time);  // as cp -p does
  fs::rename(source_, first);
  source_ = first;
  EXPECT_FALSE(leaves_it()) << "another file";
  EXPECT_TRUE(leaves_it());
  write_source('\7');
  fs::last_write_time(source_, time);
  EXPECT_FALSE(leaves_it()) << "the same file, rewritten";
}

TEST_F(SkipDone, OpacityOfTheSceneChanged_ConvertsAgain) {
  const TemporaryDirectory beside;
  const std::string scene = beside / "s.toml";
  const auto say = [&](const std::string& opacity, double azimuth) {
    write_file(scene, "[camera]\nazimuth = " + std::to_string(azimuth) +
                          "\n[volume]\nrange = [0, 255]\nopacity = " + opacity + "\n");
  };
  say("[[0, 0], [0.5, 0], [1, 1]]", 10);
  ASSERT_EQ(convert({"--scene", scene}).exit_code, 0);
  EXPECT_TRUE(leaves_it({"--scene", scene}));
  say("[[0, 0], [0.5, 0], [1, 1]]", 20);
  EXPECT_TRUE(leaves_it({"--scene", scene})) << "from where it is seen decides nothing";
  say("[[0, 1], [0.5, 0], [1, 0]]", 20);
  const CommandResult edited = convert({"--scene", scene});
  EXPECT_EQ(edited.exit_code, 0);
  EXPECT_NE(edited.err.find(output_ + ": converted again: made for a scene that said something else"),
            std::string::npos)
      << edited.err;
  EXPECT_TRUE(leaves_it({"--scene", scene}));

  auto record = nlohmann::json::parse(read_file(output_ + ".json"));
  record["visible"].erase("scene_digest");  // as an older weir wrote it
  write_file(output_ + ".json", record.dump());
  EXPECT_FALSE(leaves_it({"--scene", scene})) << "nobody knows what the scene said";
}

// The changed file has the same size and is older than another file of the volume.
TEST_F(SkipDone, OneOfSeveralSourceFilesChanged_ConvertsAgain) {
  const TemporaryDirectory beside;
  const auto rewrite = [&](const std::string& path, char fill) {
    const auto before = fs::last_write_time(path);
    write_file(path, std::string(fs::file_size(path), fill));
    fs::last_write_time(path, before - std::chrono::hours(1));
  };
  const auto expect_seen = [&](const std::vector<std::string>& input, const std::string& changed) {
    std::vector<std::string> command{"convert"};
    command.insert(command.end(), input.begin(), input.end());
    command.insert(command.end(), {"-o", beside / "o.nvdb", "--skip-done", "--overwrite"});
    ASSERT_EQ(run_weir(command).exit_code, 0);
    EXPECT_NE(run_weir(command).err.find("done already"), std::string::npos);
    rewrite(changed, 'y');
    const CommandResult again = run_weir(command);
    EXPECT_NE(again.err.find("converted again: made of other files of " + input[0] + ", or as they were before"),
              std::string::npos)
        << again.err;
    EXPECT_NE(run_weir(command).err.find("done already"), std::string::npos);
  };
  for (const char* name : {"s_1_40x32x4_uint8.raw", "s_2_40x32x4_uint8.raw", "s_3_40x32x4_uint8.raw"}) {
    write_file(beside / name, std::string(40 * 32 * 4, 'x'));
  }
  expect_seen({beside / "s_%d_40x32x4_uint8.raw", "--stack"}, beside / "s_2_40x32x4_uint8.raw");

  write_file(beside / "d.raw", std::string(40 * 32 * 4, 'x'));
  write_file(beside / "h.mhd",
             "ObjectType = Image\nNDims = 3\nDimSize = 40 32 4\nElementType = MET_UCHAR\nElementDataFile = d.raw\n");
  expect_seen({beside / "h.mhd"}, beside / "d.raw");
}

TEST_F(SkipDone, DamagedOrMissingOutput_IsConvertedAgain) {
  ASSERT_EQ(convert().exit_code, 0);
  fs::resize_file(output_, fs::file_size(output_) - 1);
  EXPECT_FALSE(leaves_it()) << "short";
  fs::remove(output_);
  ASSERT_EQ(convert().exit_code, 0) << "a sidecar alone, as a crash between the two renames leaves it";
  {
    std::fstream file(output_, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(4096 + 100).put('x');  // in the grid's head
  }
  EXPECT_FALSE(leaves_it()) << "damaged head";
}

// The state after a kill between the end of a conversion and the removal of its working files.
TEST_F(SkipDone, RemovesWhatAKilledConversionLeftBesideIt) {
  ASSERT_EQ(convert().exit_code, 0);
  const auto leave = [&] {
    const auto files = make_posix_file_system();
    Journal journal(*files, output_, {{"source", "killed"}}, {});
    journal.open("rows")->preallocate(100);
    journal.state.survey.done.add({{0, 0, 0}, {1, 1, 1}});
    journal.save_now();
    write_file(output_ + ".partial", "");
  };
  const std::vector<std::string> finished = list_directory(directory_.path());
  leave();
  EXPECT_EQ(list_directory(directory_.path()).size(), finished.size() + 4);
  EXPECT_NE(convert().err.find(output_ + ": what its conversion had left is removed\n"), std::string::npos);
  EXPECT_EQ(list_directory(directory_.path()), finished);
  EXPECT_TRUE(leaves_it());

  leave();
  ASSERT_EQ(run_weir({"convert", source_, "-o", output_, "--overwrite"}).exit_code, 0);
  EXPECT_EQ(list_directory(directory_.path()), finished);

  leave();
  {
    const auto writer = make_posix_file_system()->create(output_ + ".partial");
    const CommandResult locked = convert();
    EXPECT_EQ(locked.exit_code, 0);
    EXPECT_NE(locked.err.find(output_ + ": what its conversion had left stays: " + output_ +
                              ".partial: is being written by another process"),
              std::string::npos)
        << locked.err;
  }
  EXPECT_EQ(convert().exit_code, 0);
  EXPECT_EQ(list_directory(directory_.path()), finished);
}

TEST_F(SkipDone, RefusesToReplaceAForeignOutput) {
  write_file(output_, "precious");
  const CommandResult unknown = convert();
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_EQ(unknown.err, "weir: " + output_ + ": exists and is not of " + source_ +
                             " (has no sidecar, so that weir cannot say what it is); choose another output or "
                             "pass --overwrite\n");
  EXPECT_EQ(read_file(output_), "precious");
  EXPECT_EQ(convert({"--overwrite"}).exit_code, 0);

  const std::string other = directory_ / "w_40x32x24_uint8.raw";
  fs::copy_file(source_, other);
  const CommandResult taken = run_weir({"convert", other, "-o", output_, "--skip-done"});
  EXPECT_EQ(taken.exit_code, 2);
  EXPECT_NE(taken.err.find("(was made of " + source_ + ")"), std::string::npos) << taken.err;
  EXPECT_TRUE(fs::remove(other));
  EXPECT_TRUE(leaves_it());
}

TEST_F(SkipDone, SidecarThatTheSystemDoesNotGive_IsNoOtherFilesAndExitsWith5) {
  const std::string unreadable = unreadable_file();
  if (unreadable.empty()) GTEST_SKIP() << "this system has no file that root cannot read";
  ASSERT_EQ(convert().exit_code, 0);
  fs::remove(output_ + ".json");
  fs::create_symlink(unreadable, output_ + ".json");
  const CommandResult refused = convert();
  EXPECT_EQ(refused.exit_code, 5);
  EXPECT_EQ(refused.err, "weir: " + output_ + ".json: cannot read the sidecar; check the permissions\n");
  EXPECT_TRUE(fs::exists(output_));
  EXPECT_EQ(convert({"--overwrite"}).exit_code, 0);
  EXPECT_TRUE(leaves_it());
}

TEST_F(SkipDone, PathThatIsNotUtf8_IsRecognisedAsDone) {
  const std::string odd = directory_ / "\xff_40x32x24_uint8.raw";
  fs::rename(source_, odd);
  const std::vector<std::string> command{"convert", odd, "-o", output_, "--skip-done"};
  ASSERT_EQ(run_weir(command).exit_code, 0);
  const CommandResult again = run_weir(command);
  EXPECT_NE(again.err.find("done already"), std::string::npos) << again.err;
}

TEST_F(SkipDone, Series_ConvertsOnlyTheMissingSteps) {
  fs::copy_file(source_, directory_ / "s_1_40x32x24_uint8.raw");
  fs::copy_file(source_, directory_ / "s_2_40x32x24_uint8.raw");
  fs::create_directory(directory_ / "out");
  const std::vector<std::string> command{"convert", directory_ / "s_%d_40x32x24_uint8.raw", "-o", directory_ / "out/",
                                         "--skip-done"};
  ASSERT_EQ(run_weir(command).exit_code, 0);
  fs::remove(directory_ / "out/s_2_40x32x24_uint8.nvdb");
  const auto kept = fs::last_write_time(directory_ / "out/s_1_40x32x24_uint8.nvdb");
  const CommandResult again = run_weir(command);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_TRUE(fs::exists(directory_ / "out/s_2_40x32x24_uint8.nvdb"));
  EXPECT_EQ(fs::last_write_time(directory_ / "out/s_1_40x32x24_uint8.nvdb"), kept);
}

// Tests the lines for the program that started convert, on a descriptor of its choice.
TEST_F(SkipDone, AnnouncesOutputsToItsCaller) {
  const std::string lines = directory_ / "lines";
  for (const bool skipped : {false, true}) {
    const std::string shell = "exec \"$0\" convert \"$1\" -o \"$2\" --skip-done --progress-fd 9 9>\"$3\"";
    ASSERT_EQ(run_command({"sh", "-c", shell, WEIR_COMMAND, source_, output_, lines}).exit_code, 0);
    std::ifstream in(lines);
    std::vector<nlohmann::json> told;
    for (std::string line; std::getline(in, line);) told.push_back(nlohmann::json::parse(line));
    ASSERT_FALSE(told.empty());
    const nlohmann::json& last = told.back();
    EXPECT_EQ(last["output"], output_);
    EXPECT_EQ(last["skipped"], skipped);
    EXPECT_EQ(last["bytes"], fs::file_size(output_));
    EXPECT_EQ(last["source_bytes"], fs::file_size(source_));
    EXPECT_EQ(last["bytes_read"].get<std::uint64_t>() > 0, !skipped);
    EXPECT_EQ(told.size() > 1, !skipped);
    if (skipped) continue;
    EXPECT_EQ(told.front(),
              (nlohmann::json{{"pass", "survey"}, {"done", 0}, {"total", 40 * 32 * 24 * 4}, {"unit", "bytes"}}));
  }
}

TEST_F(SkipDone, RefusesAClosedDescriptor) {
  const CommandResult result = convert({"--progress-fd", "77"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err,
            "weir: --progress-fd: \"77\" is not the number of an open descriptor; see weir convert --help\n");
}

}  // namespace
}  // namespace weir::finished_output_test
