// Tests weir sweep as a user runs it: its figures equal those of the single commands that it replaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/run_command.h"
#include "tests/support/sanitized.h"
#include "tools/sweep/zfp_codec.h"

namespace weir::sweep_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Names = std::vector<std::string>;

const Names kResults{"psnr_bits.png",    "psnr_bits.svg", "psnr_seconds.png",
                     "psnr_seconds.svg", "sweep.csv",     "sweep.json"};

class SweepCommand : public testing::Test {
 protected:
  std::string sample(const std::string& kind, const std::string& dims_and_type) {
    const std::string path = directory_ / (kind + "_" + dims_and_type + ".raw");
    const CommandResult result = run_weir({"sample", kind, "-o", path});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return path;
  }

  // Runs a sweep that writes to out/ below the test's directory.
  CommandResult run(const std::string& input, const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"sweep", input, "-o", out_, "--progress", "never"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run_weir(arguments);
  }

  Json rows(const std::string& input, std::vector<std::string> options) {
    options.push_back("--json");
    const CommandResult result = run(input, options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(result.out, read_file(fs::path(out_) / "sweep.json"));
    return Json::parse(result.out)["rows"];
  }

  TemporaryDirectory directory_;
  std::string out_ = directory_ / "out";
};

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = at; i < at + 4; ++i) value = value << 8U | static_cast<unsigned char>(bytes.at(i));
  return value;
}

TEST_F(SweepCommand, WritesAllResultsAndNothingElse) {
  const std::string input = sample("turbulence", "100x90x80_float32");
  const CommandResult result = run(input, {"--rates", "8,4"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(list_directory(out_), kResults);
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 1 + 4 * 2);
  EXPECT_EQ(result.out.find("method  rate  bytes asked"), 0U);

  const std::string csv = read_file(fs::path(out_) / "sweep.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 4 * 2);
  for (const char* line :
       {"\nauto,fpn,8,360000,360000,4,", "\nauto,fpn,4,720000,720000,8,", "\nfloat,float32,8,360000,360000,4,",
        "\npaper,float32,4,720000,720000,8,", "\nzfp,zfp,8,360000,"}) {
    EXPECT_NE(csv.find(line), std::string::npos) << line << " in\n" << csv;
  }
  for (const char* name : {"psnr_bits.png", "psnr_seconds.png"}) {
    const std::string png = read_file(fs::path(out_) / name);
    EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
    EXPECT_EQ(big_endian(png, 16), 900U);
    EXPECT_EQ(big_endian(png, 20), 600U);
  }
}

TEST_F(SweepCommand, FiguresAreThoseOfConvert) {
  const std::string input = sample("cloud", "150x140x130_float32");
  const std::vector<std::pair<std::string, std::vector<std::string>>> methods{
      {"auto", {}},
      {"packed", {"--encoding", "packed"}},
      {"fpn", {"--encoding", "fpn"}},
      {"float", {"--encoding", "float"}},
      {"fp8", {"--encoding", "fp8"}},
      {"paper", {"--preset", "paper"}},
      {"paper32", {"--preset", "paper", "--brick", "32"}}};
  const Json found = rows(input, {"--rates", "12,6", "--methods", "auto,packed,fpn,float,fp8,paper,paper32"});
  ASSERT_EQ(found.size(), 14U);
  std::size_t i = 0;
  for (const auto& [name, options] : methods) {
    for (const std::string rate : {"12", "6"}) {
      const Json& row = found[i++];
      std::vector<std::string> convert{"convert", input, "-o",     directory_ / "one.nvdb",
                                       "--rate",  rate,  "--json", "--overwrite"};
      convert.insert(convert.end(), options.begin(), options.end());
      const CommandResult result = run_weir(convert);
      ASSERT_EQ(result.exit_code, 0) << result.err;
      const Json sidecar = Json::parse(result.out);
      EXPECT_EQ(row["method"], name);
      EXPECT_EQ(row["rate"], std::stod(rate));
      EXPECT_EQ(row["bytes_asked"], sidecar["file"]["bytes"]);
      EXPECT_EQ(row["bytes_got"], sidecar["file"]["bytes"]);
      EXPECT_EQ(row["encoding"], name == "packed" ? Json("packed") : sidecar["grid"]["type"]);
      EXPECT_EQ(row["leaves_kept"], sidecar["selection"]["leaves_kept"]);
      for (const char* key : {"mse", "nmse", "psnr_db", "max_abs", "lossless"}) {
        EXPECT_EQ(row[key], sidecar["error"][key]) << name << ' ' << rate << ' ' << key;
      }
      EXPECT_EQ(row["bits_per_voxel"], 8.0 * row["bytes_got"].get<double>() / (150 * 140 * 130));
      EXPECT_GT(row["seconds"], 0.0);
      EXPECT_DOUBLE_EQ(row["gb_per_s"], 4e-9 * 150 * 140 * 130 / row["seconds"].get<double>());
    }
  }
}

TEST_F(SweepCommand, ZfpTakesAllBitsThatFit) {
  const std::string input = sample("turbulence", "61x50x43_float32");
  const Json found = rows(input, {"--rates", "20,10,8.5", "--methods", "zfp"});
  ASSERT_EQ(found.size(), 3U);
  const Index3 extent{61, 50, 43};
  for (const Json& row : found) {
    const std::uint64_t asked = row["bytes_asked"];
    EXPECT_EQ(asked, static_cast<std::uint64_t>(std::ceil(61 * 50 * 43 * 4 / row["rate"].get<double>())));
    const unsigned bits = zfp_block_bits(extent, asked).value();
    EXPECT_EQ(row["bytes_got"], zfp_stream_bytes(extent, bits));
    EXPECT_LE(row["bytes_got"], asked);
    EXPECT_GT(zfp_stream_bytes(extent, bits + 1), asked);
    EXPECT_TRUE(row["leaves_kept"].is_null());
    EXPECT_EQ(row["encoding"], "zfp");
  }
  EXPECT_LT(found[0]["psnr_db"], found[1]["psnr_db"]);
  EXPECT_LT(found[1]["psnr_db"], found[2]["psnr_db"]);
}

TEST_F(SweepCommand, UnreachableRates_AreNoted) {
  const std::string input = sample("turbulence", "64x64x64_float32");
  const Json found = rows(input, {"--rates", "1000,2", "--methods", "auto,float,zfp"});
  ASSERT_EQ(found.size(), 6U);
  for (const std::size_t i : {0U, 2U, 4U}) {
    EXPECT_EQ(found[i]["bytes_asked"], 1049);
    EXPECT_TRUE(found[i]["bytes_got"].is_null());
    EXPECT_TRUE(found[i]["psnr_db"].is_null());
    EXPECT_EQ(found[i + 1]["rate"], 2.0);
    EXPECT_EQ(found[i + 1]["note"], "");
    EXPECT_GT(found[i + 1]["psnr_db"], 0.0);
  }
  const std::string note = found[0]["note"];
  EXPECT_EQ(note.find("1049 bytes asked, the smallest tree for this volume takes "), 0U) << note;
  EXPECT_EQ(found[4]["note"], "1049 bytes asked, ZFP takes 4608 or more: 9 bits a block of 4^3 voxels");
}

TEST_F(SweepCommand, NoRateReachable_StillWritesAllResults) {
  const CommandResult result = run(sample("sphere", "16x16x16_uint8"), {"--rates", "5000,4000"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(list_directory(out_), kResults);
}

TEST_F(SweepCommand, PaddingOfALosslessFile_IsNoted) {
  const Json found = rows(sample("sphere", "96x96x96_uint8"), {"--rates", "1", "--methods", "auto"});
  EXPECT_EQ(found[0]["lossless"], true);
  EXPECT_TRUE(found[0]["psnr_db"].is_null());
  const std::string note = found[0]["note"];
  EXPECT_EQ(note.find("lossless takes "), 0U) << note;
  EXPECT_EQ(note.find("--at-most"), std::string::npos) << note;
}

TEST_F(SweepCommand, NonFiniteVolumes) {
  const std::string input = sample("some-nan", "97x40x40_float32");
  const CommandResult refused = run(input, {"--rates", "2"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("choose --nonfinite background or --nonfinite keep\n"), std::string::npos) << refused.err;
  EXPECT_FALSE(fs::exists(out_));
  const Json found = rows(input, {"--rates", "0.5", "--nonfinite", "keep"});
  EXPECT_EQ(found[0]["encoding"], "float32");
  EXPECT_EQ(found[3]["note"], "ZFP has no code for NaN and infinity, which 4800 voxels are");
  EXPECT_TRUE(found[3]["mse"].is_null());
}

TEST_F(SweepCommand, ZfpOverflowIsANote) {
  const std::string input = directory_ / "max_32x32x32_float32.raw";
  std::minstd_rand random;
  std::vector<float> values(32 * 32 * 32);
  for (float& value : values)
    value = random() % 2 == 0 ? std::numeric_limits<float>::max() : -std::numeric_limits<float>::max();
  write_file(input, {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
  const Json found = rows(input, {"--rates", "10", "--methods", "zfp"});
  const std::string note = found[0]["note"];
  EXPECT_EQ(note.find("what ZFP gives back overflows float32 in "), 0U) << note;
  EXPECT_TRUE(found[0]["max_abs"].is_null());
}

TEST_F(SweepCommand, InputOptionsApply) {
  const std::string input = sample("turbulence", "70x60x50_int16be");
  const Json region = rows(input, {"--roi", "3:64,5:52,9:50", "--rates", "3", "--methods", "auto,zfp"});
  EXPECT_EQ(region[0]["bytes_asked"], (61 * 47 * 41 * 4 + 2) / 3);
  EXPECT_EQ(Json::parse(read_file(fs::path(out_) / "sweep.json"))["extent"], (Json{61, 47, 41}));
}

TEST_F(SweepCommand, KeepOption_KeepsTheConvertedVolumes) {
  const std::string input = sample("turbulence", "64x64x64_float32");
  ASSERT_EQ(run(input, {"--rates", "2.5", "--methods", "auto,paper32,zfp", "--keep"}).exit_code, 0);
  Names expected{"auto_rate2.5.nvdb", "auto_rate2.5.nvdb.json", "paper32_rate2.5.nvdb", "paper32_rate2.5.nvdb.json"};
  expected.insert(expected.end(), kResults.begin(), kResults.end());
  EXPECT_EQ(list_directory(out_), expected);
  for (const char* name : {"auto_rate2.5.nvdb", "paper32_rate2.5.nvdb"}) {
    EXPECT_EQ(run_weir({"verify", (fs::path(out_) / name).string()}).exit_code, 0) << name;
  }
  const Json options = Json::parse(read_file(fs::path(out_) / "paper32_rate2.5.nvdb.json"))["weir"]["options"];
  EXPECT_EQ(options, (Json{{"preset", "paper"}, {"brick", "32"}, {"rate", "2.5"}}));
}

TEST_F(SweepCommand, ReplacesFilesOnlyWithOverwrite) {
  const std::string input = sample("sphere", "32x32x32_uint8");
  fs::create_directory(out_);
  const auto refused_for = [&](const std::string& name) {
    write_file(fs::path(out_) / name, "mine");
    const CommandResult result = run(input, {"--rates", "2", "--methods", "auto"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err,
              "weir: " + out_ + "/" + name + ": exists; choose another directory with -o or pass --overwrite\n");
    EXPECT_EQ(list_directory(out_), Names{name});
    EXPECT_EQ(read_file(fs::path(out_) / name), "mine");
    fs::remove(fs::path(out_) / name);
  };
  for (const char* name : {"sweep.csv", "psnr_bits.png", "auto_rate2.nvdb", "auto_rate2.nvdb.json"}) refused_for(name);
  write_file(fs::path(out_) / "sweep.json", "old");
  EXPECT_EQ(run(input, {"--rates", "2", "--overwrite"}).exit_code, 0);
  EXPECT_EQ(list_directory(out_), kResults);
}

TEST_F(SweepCommand, OverwriteOption_LeavesVolumesThatAnEarlierSweepKept) {
  const std::string input = sample("turbulence", "64x64x64_float32");
  ASSERT_EQ(run(input, {"--rates", "2.5", "--methods", "auto", "--keep"}).exit_code, 0);
  const std::string kept = (fs::path(out_) / "auto_rate2.5.nvdb").string();
  const std::string bytes = read_file(kept);
  const Names before = list_directory(out_);
  ASSERT_EQ(run(input, {"--rates", "2.5", "--methods", "auto", "--overwrite"}).exit_code, 0);
  EXPECT_EQ(list_directory(out_), before);
  EXPECT_EQ(read_file(kept), bytes);
}

TEST_F(SweepCommand, RateBelowTheSmallestTree_IsANoteWithoutOptionsOfConvert) {
  const std::string input = sample("turbulence", "20x17x13_float32");
  EXPECT_EQ(rows(input, {"--rates", "20", "--methods", "auto"})[0]["note"],
            "884 bytes asked, the smallest tree for this volume takes 309824");
}

TEST_F(SweepCommand, Refusals) {
  const std::string input = sample("sphere", "32x32x32_uint8");
  const auto refusal = [&](const std::vector<std::string>& options, int exit_code) {
    const CommandResult result = run(input, options);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(result.out, "");
    EXPECT_FALSE(fs::exists(out_));
    return result.err;
  };
  EXPECT_EQ(refusal({"--rates", "8,8"}, 2), "weir: --rates holds 8 twice; leave one of them out\n");
  EXPECT_EQ(refusal({"--methods", ""}, 2),
            "weir: --methods names \"\", choose from auto, packed, fpn, float, fp4, fp8, fp16, paper, "
            "paper32, zfp\n");
  EXPECT_EQ(refusal({"--dims", "32,32,31"}, 2).find("weir: " + input + ": --dims 32,32,31 contradicts"), 0U);
  EXPECT_EQ(run_weir({"sweep", directory_ / "none.raw", "-o", out_}).exit_code, 3);
  EXPECT_FALSE(fs::exists(out_));
  EXPECT_EQ(run_weir({"sweep", input}).err, "weir: --output is required; see weir sweep --help\n");
  EXPECT_EQ(run_weir({"sweep", input, "-o", input}).err,
            "weir: " + input + ": is no directory; choose another one with -o\n");
  EXPECT_EQ(run_weir({"sweep", input, "-o", input + "/a/b"}).err,
            "weir: " + input + ": is no directory; choose another one with -o\n");
}

TEST_F(SweepCommand, InterruptLeavesNothing) {
  // Zeros that take no disk space. Reading them takes so long that the signal arrives during the sweep.
  const std::string input = directory_ / "zeros_1024x1024x256_uint8.raw";
  write_file(input, "");
  fs::resize_file(input, std::uintmax_t{1} << 28U);
  for (const std::string method : {"auto", "zfp"}) {
    ChildProcess child({WEIR_COMMAND, "sweep", input, "-o", out_, "--methods", method, "--progress", "never"});
    while (child.running() && !fs::exists(out_)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    child.send_signal(SIGINT);
    const CommandResult result = child.wait();
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_EQ(result.err.find("weir: interrupted"), 0U) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_FALSE(fs::exists(out_));
  }
}

TEST_F(SweepCommand, InterruptWithKeep_NamesTheVolumesThatStay) {
  const std::string input = directory_ / "zeros_1024x1024x256_uint8.raw";
  write_file(input, "");
  fs::resize_file(input, std::uintmax_t{1} << 28U);
  ChildProcess child({WEIR_COMMAND, "sweep", input, "-o", out_, "--keep", "--methods", "auto,float", "--rates",
                      "100,50", "--progress", "never"});
  const auto begun = [&](const char* name) { return fs::exists(fs::path(out_) / (std::string(name) + ".partial")); };
  while (child.running() && !begun("auto_rate50.nvdb")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  child.send_signal(SIGINT);
  const CommandResult result = child.wait();
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_EQ(result.err, "weir: interrupted; no report was written, and 1 volume is kept in " + out_ +
                            "; choose another directory with -o or pass --overwrite to begin anew\n");
  EXPECT_EQ(list_directory(out_), (Names{"auto_rate100.nvdb", "auto_rate100.nvdb.json"}));
}

TEST_F(SweepCommand, BoundedMemory) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const std::string input = sample("gradient", "400x400x400_float32");  // 244 MiB
  const CommandResult result =
      run(input, {"--rates", "4", "--methods", "auto,zfp", "--memory", "128MiB", "--threads", "2", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_LT(Json::parse(result.out)["peak_rss_bytes"], std::uint64_t{128} << 20U);
  EXPECT_LT(result.peak_rss_bytes, std::uint64_t{128} << 20U);
}

}  // namespace
}  // namespace weir::sweep_test
