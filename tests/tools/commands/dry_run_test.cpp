// Tests what weir convert --dry-run prints, that it leaves nothing, and that it fails as the conversion does.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/run_command.h"
#include "tests/support/scoped_mount.h"

namespace weir::dry_run_test {
namespace {

class DryRunTest : public testing::Test {
 protected:
  DryRunTest() {
    const auto made = run_weir({"sample", "turbulence", "--dims", "96,80,72", "-o", input_});
    EXPECT_EQ(made.exit_code, 0) << made.err;
  }
  CommandResult convert(std::vector<std::string> words) const {
    words.insert(words.begin(), {"convert", input_});
    return run_weir(words);
  }
  CommandResult dry_run(std::vector<std::string> words) const {
    words.emplace_back("--dry-run");
    return convert(words);
  }

  TemporaryDirectory directory_;
  std::string input_ = directory_ / "t_96x80x72_float32.raw";
  std::string output_ = directory_ / "t.nvdb";
};

TEST_F(DryRunTest, Json_HasTheFiguresOfTheSidecar) {
  for (const std::vector<std::string>& method : {std::vector<std::string>{"--rate", "5"},
                                                 {"--psnr", "50"},
                                                 {"--lossless"},
                                                 {"--rate", "16", "--encoding", "packed"}}) {
    std::vector<std::string> words{"-o", output_, "--json", "--threads", "2"};
    words.insert(words.end(), method.begin(), method.end());
    const auto said = dry_run(words);
    ASSERT_EQ(said.exit_code, 0) << said.err;
    EXPECT_EQ(list_directory(directory_.path()), std::vector<std::string>{"t_96x80x72_float32.raw"});
    const auto forecast = nlohmann::json::parse(said.out);
    const auto made = convert(words);
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const auto sidecar = nlohmann::json::parse(made.out);
    EXPECT_EQ(forecast["dry_run"], 1);
    EXPECT_EQ(forecast["input"], input_);
    EXPECT_EQ(forecast["output"], output_);
    EXPECT_EQ(forecast["exact"], true);
    EXPECT_EQ(forecast["sample"]["share"], 1.0);
    EXPECT_EQ(forecast["sample"]["none"], nullptr);
    EXPECT_EQ(forecast["read"]["volume_bytes"], 96 * 80 * 72 * 4);
    EXPECT_EQ(forecast["read"]["bytes"], sidecar["timing"]["bytes_read"]);
    EXPECT_EQ(forecast["file"]["value"], sidecar["file"]["bytes"]);
    EXPECT_EQ(forecast["file"]["exact"], true);
    EXPECT_EQ(forecast["file"]["low"], nullptr);
    EXPECT_EQ(forecast["error"]["lossless"], sidecar["error"]["lossless"]);
    EXPECT_EQ(forecast["error"]["rmse"], sidecar["error"]["rmse"]);
    EXPECT_EQ(forecast["error"]["max_abs"], sidecar["error"]["max_abs"]);
    EXPECT_EQ(forecast["error"]["value_range"], sidecar["value_range"]);
    if (method[0] != "--lossless") {
      EXPECT_EQ(forecast["error"]["psnr_db"]["value"], sidecar["error"]["psnr_db"]);
    }
    EXPECT_EQ(forecast["threads"], 2);
    EXPECT_EQ(forecast["backend"], "cpu");
    EXPECT_EQ(forecast["memory"]["ceiling_bytes"], 512 << 20);
    EXPECT_LE(forecast["memory"]["planned_bytes"], 512 << 20);
    EXPECT_GE(forecast["memory"]["planned_bytes"], sidecar["timing"]["peak_rss_bytes"]);
    EXPECT_GT(forecast["time"]["total_s"], 0);
    for (const char* name : {"t.nvdb", "t.nvdb.json"}) std::filesystem::remove(directory_ / name);
  }
}

TEST_F(DryRunTest, CertifiedGradient_IsThatOfTheTrialItself) {
  const std::vector<std::string> words{"-o", output_, "--json", "--psnr", "40", "--certify", "gradient"};
  const std::string partial = output_ + ".partial";
  for (const bool foreign : {false, true}) {
    if (foreign) write_file(partial, "somebody's");
    const auto said = dry_run(words);
    ASSERT_EQ(said.exit_code, 0) << said.err;
    EXPECT_EQ(list_directory(directory_.path()).size(), foreign ? 2U : 1U);
    if (foreign) {
      EXPECT_EQ(read_file(partial), "somebody's");
      std::filesystem::remove(partial);
    }
    const auto made = convert(words);
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(nlohmann::json::parse(said.out)["file"]["value"], nlohmann::json::parse(made.out)["file"]["bytes"]);
    for (const char* name : {"t.nvdb", "t.nvdb.json"}) std::filesystem::remove(directory_ / name);
  }
}

TEST_F(DryRunTest, Lines_SayWhatItComesTo) {
  const auto said = dry_run({"-o", output_, "--size", "400000", "--threads", "2"});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(said.err, "");
  const std::regex form(R"(.*t_96x80x72_float32\.raw: 96x80x72 voxels of float32, 2\.1 MiB
  sample    all of the volume was converted and nothing kept: file and error are exact
  reads     [0-9.]+ MiB in [0-9.]+ passes
  writes    .*t\.nvdb: 400000 bytes
  memory    up to [0-9.]+ MiB of 512\.0 MiB, 2 threads
  encoding  fpn
  error     PSNR [0-9.]+ dB, RMSE [0-9.]+, largest error [0-9.]+, values from -?[0-9.]+ to [0-9.]+
  time      about [0-9.]+ s: survey [0-9.]+ s, encoding [0-9.]+ s
)");
  EXPECT_TRUE(std::regex_match(said.out, form)) << said.out;
}

// The values 2^53 .. 2^53 + 4095: float32 has one value in 2^30 there.
TEST_F(DryRunTest, WhatFloat32Rounds_IsSaidAsOfTheConversion) {
  std::string bytes;
  for (std::int64_t i = 0; i < 4096; ++i) {
    const std::int64_t value = (std::int64_t{1} << 53) + i;
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  const std::string raw = directory_ / "n_16x16x16_int64.raw";
  write_file(raw, bytes);
  for (const std::vector<std::string>& budget : {std::vector<std::string>{}, {"--lossless"}}) {
    std::vector<std::string> words{"convert", raw, "-o", output_, "--dry-run"};
    words.insert(words.end(), budget.begin(), budget.end());
    const auto said = run_weir(words);
    ASSERT_EQ(said.exit_code, 0) << said.err;
    EXPECT_NE(said.out.find("\n  rounded   4095 values rounded to float32, by up to 4095; the error does not count "
                            "that\n"),
              std::string::npos)
        << said.out;
    EXPECT_NE(said.err.find(raw + ": 4095 values were rounded to float32"), std::string::npos) << said.err;
    words.emplace_back("--json");
    const auto forecast = nlohmann::json::parse(run_weir(words).out);
    words.erase(words.begin() + 4);
    const auto made = run_weir(words);
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(forecast["conversion_loss"], nlohmann::json::parse(made.out)["conversion_loss"]);
    EXPECT_EQ(forecast["conversion_loss"]["inexact"], 4095);
    for (const char* name : {"t.nvdb", "t.nvdb.json"}) std::filesystem::remove(directory_ / name);
  }
}

TEST_F(DryRunTest, Errors_AreTheConversions) {
  const std::string missing = directory_ / "no/t.nvdb";
  write_file(directory_ / "taken.nvdb", "somebody's");
  for (const std::vector<std::string>& words : {std::vector<std::string>{"-o", missing},
                                                {"-o", directory_ / "taken.nvdb"},
                                                {"-o", output_, "--size", "1000"},
                                                {"-o", output_, "--memory", "1MiB", "--threads", "2"},
                                                {"-o", output_, "--psnr", "150", "--encoding", "fp4"},
                                                {"-o", output_, "--work-dir", directory_ / "no"},
                                                {"-o", output_, "--rate", "-1"}}) {
    const auto dry = dry_run(words);
    const auto real = convert(words);
    EXPECT_NE(dry.exit_code, 0);
    EXPECT_EQ(dry.exit_code, real.exit_code);
    EXPECT_EQ(dry.err, real.err);
  }
  EXPECT_EQ(list_directory(directory_.path()), (std::vector<std::string>{"t_96x80x72_float32.raw", "taken.nvdb"}));
}

TEST_F(DryRunTest, ResumeOnInAMemoryFileSystem_IsRefusedAsByTheConversion) {
  const std::string memory = directory_ / "memory";
  std::filesystem::create_directory(memory);
  const ScopedMount mount(memory, 8 << 20);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  const std::string output = memory + "/t.nvdb";
  const auto dry = dry_run({"-o", output, "--resume", "on"});
  EXPECT_EQ(dry.exit_code, 2);
  EXPECT_EQ(dry.out, "");
  EXPECT_EQ(dry.err, "weir: --resume on: " + output +
                         " lies on a memory file system; choose an output on a disk or --resume off\n");
  EXPECT_EQ(list_directory(memory), std::vector<std::string>{});
  const auto real = convert({"-o", output, "--resume", "on"});
  EXPECT_EQ(real.exit_code, 2);
  EXPECT_EQ(real.err, dry.err);
  EXPECT_EQ(dry_run({"-o", output, "--resume", "off"}).exit_code, 0);
}

TEST_F(DryRunTest, MissingDirectory_IsNotLeft) {
  const auto said = dry_run({"-o", directory_ / "new/"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.out.find("new/t_96x80x72_float32.nvdb: "), std::string::npos) << said.out;
  EXPECT_EQ(list_directory(directory_.path()), std::vector<std::string>{"t_96x80x72_float32.raw"});
}

TEST_F(DryRunTest, Series_HasAForecastForEachStep) {
  std::filesystem::copy(input_, directory_ / "u_96x80x72_float32.raw");
  const auto said = run_weir({"convert", input_, directory_ / "u_96x80x72_float32.raw", "-o", directory_ / "out/",
                              "--rate", "5", "--dry-run", "--json"});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  const auto json = nlohmann::json::parse(said.out);
  ASSERT_EQ(json["steps"].size(), 2U);
  EXPECT_EQ(json["steps"][1]["output"], directory_ / "out/u_96x80x72_float32.nvdb");
  EXPECT_EQ(json["steps"][0]["error"], json["steps"][1]["error"]);
}

TEST_F(DryRunTest, DoneOutput_IsSaidToBeDone) {
  ASSERT_EQ(convert({"-o", output_}).exit_code, 0);
  const std::string volume = read_file(output_);
  const auto said = dry_run({"-o", output_, "--skip-done", "--json"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(nlohmann::json::parse(said.out)["done"], true);
  const auto other = dry_run({"-o", output_, "--skip-done", "--rate", "5", "--json"});
  EXPECT_EQ(other.exit_code, 0) << other.err;
  EXPECT_EQ(nlohmann::json::parse(other.out)["file"]["value"], 96 * 80 * 72 * 4 / 5);
  EXPECT_NE(other.err.find(output_ + ": would be converted again: made with other options"), std::string::npos)
      << other.err;
  EXPECT_EQ(read_file(output_), volume);
}

TEST_F(DryRunTest, WithATrace_IsRefused) {
  const auto refused = dry_run({"-o", output_, "--trace", directory_ / "trace.json"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("--trace"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace weir::dry_run_test
