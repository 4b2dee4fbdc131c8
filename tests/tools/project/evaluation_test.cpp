// Tests bench/evaluate.sh --quick: the evaluation runs, continues after an interruption, keeps weir's promises, and
// reports its figures.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "format/base/text.h"
#include "tests/support/python.h"
#include "tests/support/run_command.h"
#include "tests/support/sanitized.h"

namespace weir::evaluation_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class Evaluation : public testing::Test {
 protected:
  void SetUp() override {
    if (kSanitized) GTEST_SKIP() << "hundreds of conversions, which other tests run sanitized";
  }

  // Runs the evaluation in the test's directory.
  CommandResult evaluate(std::vector<std::string> options) {
    std::vector<std::string> command{kPython,  "-B",         std::string(WEIR_SOURCE_DIR) + "/bench/evaluate",
                                     "--weir", WEIR_COMMAND, directory_.path().string()};
    command.insert(command.end(), options.begin(), options.end());
    CommandOptions run;
    run.timeout = std::chrono::minutes(5);  // for a busy machine
    return run_command(command, run);
  }

  std::string report() { return read_file(directory_ / "evaluation.md"); }
  Json figures() { return Json::parse(read_file(directory_ / "evaluation.json")); }

  TemporaryDirectory directory_;
};

TEST_F(Evaluation, QuickRun_WritesAllFiguresAndTheReport) {
  const CommandResult run = evaluate({"--quick"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, (directory_ / "evaluation.md") + "\n");

  const Json all = figures();
  EXPECT_EQ(all["sizes"].size(), 2 * 3 * 4U);  // volumes, methods, rates
  for (const Json& row : all["sizes"]) EXPECT_EQ(row["bytes_got"], row["bytes_asked"]) << row;
  ASSERT_EQ(all["worst_case"].size(), 2 * 2U);  // edges, encodings
  EXPECT_EQ(all["worst_case"][0]["bytes"], 446752);
  EXPECT_EQ(all["worst_case"][0]["fixed_bytes"], 4096 + 800 + 32 + 270400 + 33856 + 288);
  EXPECT_EQ(all["worst_case"][1]["encoding"], "packed");
  EXPECT_EQ(all["worst_case"][1]["fixed_bytes"], 4096 + 800 + 32 + 2 * 288 + 96 + 3840 + 16 + 1548);
  EXPECT_EQ(all["worst_case"][2]["bytes"], 1407712);
  EXPECT_EQ(all["errors"].size(), 2 * 5 * 10U);          // volumes, methods, shares
  EXPECT_EQ(all["few_bytes"].size(), 4 * 5U);            // volumes, shares
  EXPECT_GE(all["peers"].size(), 2 * 2 * (3 + 5 + 1U));  // volumes, encodings; dB, shares, speeds
  for (const Json& row : all["few_bytes"]) EXPECT_EQ(row["packed_bytes"], row["bytes_asked"]) << row;
  ASSERT_EQ(all["lossless"].size(), 1U);
  EXPECT_LT(all["lossless"][0]["packed_bytes"], all["lossless"][0]["auto_bytes"]);
  EXPECT_GE(all["derived"].size(),
            4 * 2 * 1U);  // volumes, shares, methods; leaves fit into no share, ZFP may be missing
  for (const Json& row : all["derived"]) {
    if (row["gradient_rms_certified"].is_null()) continue;
    EXPECT_NEAR(row["gradient_rms_certified"].get<double>(), row["gradient_rms"].get<double>(),
                1e-6 * row["gradient_rms"].get<double>())
        << row;
  }
  EXPECT_EQ(all["metrics"].size(), 2 * 2 * (4 * 2 + 1U));  // volumes, rates; metrics, fills; packed
  EXPECT_GE(all["speed"].size(), 3 * 2U);  // encodings, caches; more rows if there are threads to compare
  const std::size_t places = std::filesystem::exists("/dev/shm") ? 2 : 1;
  EXPECT_EQ(all["two_passes"].size(), places * 5U);  // cases
  for (const char* stage : {"read", "survey", "encode", "select", "commit"}) {
    EXPECT_EQ(std::ranges::count(all["stages"], stage, [](const Json& row) { return row["stage"]; }), 2 * 3) << stage;
  }
  ASSERT_EQ(all["headline"].size(), 2U);
  for (const Json& row : all["headline"]) EXPECT_TRUE(row["same_bytes"]) << row;

  ASSERT_GE(all["pictures"].size(), 1 + 3 * 2U);  // another seed; methods, rates; ZFP only if installed
  for (const Json& row : all["pictures"]) {
    const bool same_seed = !row["rate"].is_null();
    if (row["lossless"] && same_seed) {
      EXPECT_EQ(row["flip_mean"], 0) << row;
    } else if (row["method"] != "packed") {  // an error of packed may be invisible in 8 bits
      EXPECT_GT(row["flip_mean"], 0) << row;
    }
  }

  const std::string text = report();
  for (const char* title : {"# Evaluation", "## Bytes for an error", "## Actual size", "## Worst case",
                            "## Error against size", "## Few bytes", "## Lossless", "## What people derive", "## ZFP",
                            "## There and back", "## Pictures", "## Time and memory"}) {
    EXPECT_NE(text.find(title), std::string::npos) << title;
  }
  EXPECT_NE(text.find("| 32^3 | auto | 131,072 | 446,752 | +240.84 % | +4.74 % | 447,752 |\n"), std::string::npos)
      << text;
  for (const auto& [name, rows] : all.items()) {
    EXPECT_EQ(text.find("@" + name + "@"), std::string::npos) << name << " is no place in report.md";
  }
  EXPECT_EQ(text.find("Promises that are not kept"), std::string::npos);
  for (const char* name : {"wdas-like_124x84x153_psnr.png", "headline.png", "turbulence_spectrum.png"}) {
    EXPECT_TRUE(fs::exists(directory_.path() / "images/evaluation" / name)) << name;
  }
  const std::string sheet = directory_ / "images/evaluation/cloud_path.png";
  const CommandResult flip = run_weir({"flip", sheet, sheet, "--json"});
  ASSERT_EQ(flip.exit_code, 0) << flip.err;
  EXPECT_EQ(Json::parse(flip.out)["width"], 3 * 64 + 2 * 4);  // pictures and the gaps between them
  EXPECT_EQ(Json::parse(flip.out)["height"], 9 * 48 + 8 * 4);
  for (const char* name : {"sizes", "worst_case", "errors", "few_bytes", "lossless", "derived", "metrics", "pictures",
                           "speed", "two_passes", "stages", "headline"}) {
    EXPECT_TRUE(fs::exists(directory_ / (std::string(name) + ".csv"))) << name;
  }
}

TEST_F(Evaluation, ResumesMissingMeasurementsAndReportsWrongOnes) {
  ASSERT_EQ(evaluate({"--quick", "--only", "worst_case"}).err,
            "worst_case: noise_0032_auto\nworst_case: noise_0032_packed\nworst_case: noise_0064_auto\n"
            "worst_case: noise_0064_packed\n");
  EXPECT_NE(report().find("*Not measured yet.*"), std::string::npos);
  const fs::path state = directory_.path() / "state/worst_case";
  fs::remove(state / "noise_0032_packed.json");
  EXPECT_EQ(evaluate({"--quick", "--only", "worst_case"}).err, "worst_case: noise_0032_packed\n");

  Json record = Json::parse(read_file(state / "noise_0064_auto.json"));
  record["result"]["bytes"] = 1500000;
  write_file(state / "noise_0064_auto.json", record.dump());
  const CommandResult run = evaluate({"--report"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.err,
            "worst_case: auto, noise of 64^3 takes 1500000 bytes, the format says 1407712\n"
            "worst_case: auto, noise of 64^3 takes 1500000 bytes, the bound is 1415719\n");
  EXPECT_NE(report().find("* worst_case: auto, noise of 64^3 takes 1500000 bytes, the format says 1407712\n"),
            std::string::npos);
}

TEST_F(Evaluation, Interrupted_EndsAndKeepsFinishedMeasurements) {
  ChildProcess child({kPython, "-B", std::string(WEIR_SOURCE_DIR) + "/bench/evaluate", "--weir", WEIR_COMMAND,
                      directory_.path().string(), "--quick", "--only", "errors"});
  const fs::path state = directory_.path() / "state/errors";
  const std::string first = "wdas-like_124x84x153_float32.raw.json";
  while (child.running() && !fs::exists(state / first)) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  child.send_signal(SIGTERM);  // the second volume is being measured
  const CommandResult result = child.wait();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("bench/evaluate.sh: interrupted; what is measured is kept, run it again to go on\n"),
            std::string::npos)
      << result.err;
  EXPECT_EQ(list_directory(state), std::vector<std::string>{first});
}

// A script in place of sz3. It rounds values within the error bound and deflates them.
constexpr const char* kPretendedSz3 = R"(
import array, sys, zlib
given = sys.argv[1:]
if given == ["-v"]:
    print("SZ3 Version: 9.9.9")
    sys.exit()
option = lambda name: given[given.index(name) + 1]
if "-i" in given:
    step = 2 * float(option("ABS"))
    values = array.array("f")
    values.frombytes(open(option("-i"), "rb").read())
    codes = array.array("q", [round(v / step) for v in values])
    open(option("-z"), "wb").write(array.array("d", [step]).tobytes() + zlib.compress(codes.tobytes(), 1))
else:
    stream = open(option("-z"), "rb").read()
    step = array.array("d", stream[:8])[0]
    codes = array.array("q", zlib.decompress(stream[8:]))
    open(option("-o"), "wb").write(array.array("f", [code * step for code in codes]).tobytes())
)";

TEST_F(Evaluation, APeerIsMeasuredWhereItIsFoundAndKeptWhereNot) {
  const std::string sz3 = directory_ / "sz3";
  write_file(sz3, cat("#!", kPython, kPretendedSz3));
  fs::permissions(sz3, fs::perms::owner_all);
  const std::vector<std::string> quick{"--quick", "--only", "peers", "--kept", directory_ / "kept.json"};
  std::vector<std::string> found = quick;
  found.insert(found.end(), {"--sz3", sz3, "--sz3-commit", "0123456789abcdef"});
  const CommandResult run = evaluate(found);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("peers: SPERR skipped, the command sperr3d is not found\n"), std::string::npos) << run.err;

  std::size_t targets = 0;
  Json theirs = Json::array();
  const Json first = figures();
  for (const Json& row : first["peers"]) {
    if (row["method"] == "zfp_rate" && !row["share"].is_null()) {  // the most whole bits per 4^3 block
      const double asked = row["share"].get<double>() / 100 * 4 * 48 * 48 * 48;
      EXPECT_LE(row["bytes"], asked) << row;
      EXPECT_GT(row["bytes"], asked - (12 * 12 * 12 / 8 + 16)) << row;
    }
    if (row["method"] != "sz3") continue;
    if (row["threads"].is_null()) theirs.push_back(row);
    EXPECT_EQ(row["version"], "SZ3 9.9.9 of 0123456789ab");
    if (row["target_db"].is_null()) continue;
    EXPECT_GE(row["psnr_db"], row["target_db"]) << row;
    EXPECT_LE(row["psnr_db"], row["target_db"].get<double>() + 0.1) << row;
    ++targets;
  }
  EXPECT_EQ(targets, 2 * 3U);  // volumes, dB
  EXPECT_NE(report().find("| auto | SZ3, bytes for a PSNR, in "), std::string::npos) << report();
  EXPECT_NE(report().find("SZ3 9.9.9 of 0123456789ab"), std::string::npos);

  // Keeps the peers' records like --publish, and then removes the records of SZ3 from the directory.
  const std::string source = WEIR_SOURCE_DIR;
  const CommandResult keep =
      run_command({kPython, "-B", "-c",
                   "import pathlib, sys; sys.path.insert(0, sys.argv[1])\n"
                   "from experiments.peers import keep_records\nfrom store import Store\n"
                   "keep_records(Store(sys.argv[2]), pathlib.Path(sys.argv[3]))",
                   source + "/bench/evaluate", directory_.path().string(), directory_ / "kept.json"});
  ASSERT_EQ(keep.exit_code, 0) << keep.err;
  const Json kept = Json::parse(read_file(directory_ / "kept.json"));
  std::size_t removed = 0;
  for (const Json& record : kept) {
    EXPECT_NE(record["result"]["method"], "packed");
    if (record["result"]["method"] != "sz3") continue;
    fs::remove(directory_.path() / "state/peers" / (record["name"].get<std::string>() + ".json"));
    ++removed;
  }
  ASSERT_EQ(removed, 2U);
  const CommandResult without = evaluate(quick);
  ASSERT_EQ(without.exit_code, 0) << without.err;
  EXPECT_NE(without.err.find("peers: SZ3 skipped, the command sz3 is not found; its figures are those that are kept\n"),
            std::string::npos)
      << without.err;
  Json again = Json::array();
  const Json second = figures();
  for (const Json& row : second["peers"]) {
    if (row["method"] == "sz3") again.push_back(row);
  }
  EXPECT_EQ(again, theirs);  // without the speeds, because the seconds of another run are not comparable with weir's
}

TEST_F(Evaluation, UnknownExperiment_IsRefusedWithTheKnownNames) {
  const CommandResult run = evaluate({"--only", "sizes,speeds"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("bench/evaluate.sh: error: --only names speeds; there are sizes, worst_case, errors"),
            std::string::npos)
      << run.err;
}

}  // namespace
}  // namespace weir::evaluation_test
