// Tests weir export from outside: volumes that weir made, read by OpenVDB and by its stock tool.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "format/base/text.h"
#include "format/nanovdb/nvdb_file.h"
#include "tests/stock/openvdb_file.h"
#include "tests/stock/stock_nvdb.h"
#include "tests/stock/vdb_oracle.h"
#include "tests/support/run_command.h"
#include "tests/support/sanitized.h"
#include "tests/support/scoped_mount.h"
#include "tools/export/vdb_node_values.h"

namespace weir::export_test {
namespace {

class ExportCommand : public testing::Test {
 protected:
  void sample(const std::string& kind, const std::string& dims, const std::vector<std::string>& options) {
    const CommandResult sampled = run_weir({"sample", kind, "--dims", dims, "-o", raw_, "--overwrite"});
    ASSERT_EQ(sampled.exit_code, 0) << sampled.err;
    convert(raw_, dims, options);
  }
  void convert(const std::string& input, const std::string& dims, const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"convert", input, "-o", nvdb_, "--overwrite"};
    if (!dims.empty()) arguments.insert(arguments.end(), {"--dims", dims, "--type", "float32"});
    arguments.insert(arguments.end(), options.begin(), options.end());
    const CommandResult converted = run_weir(arguments);
    ASSERT_EQ(converted.exit_code, 0) << converted.err;
  }
  nlohmann::json exported(std::vector<std::string> options = {}) {
    options.insert(options.begin(), {"export", nvdb_, "-o", vdb_, "--overwrite", "--json", "--progress", "never"});
    const CommandResult result = run_weir(options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? nlohmann::json::parse(result.out) : nlohmann::json();
  }
  void expect_refused(const std::vector<std::string>& arguments, int code, const std::string& message) {
    const CommandResult result = run_weir(arguments);
    EXPECT_EQ(result.exit_code, code);
    EXPECT_EQ(result.err, "weir: " + message + '\n');
    EXPECT_EQ(result.out, "");
    EXPECT_FALSE(std::filesystem::exists(vdb_ + ".partial"));
  }

  TemporaryDirectory directory_;
  std::string raw_ = directory_ / "v.raw";
  std::string nvdb_ = directory_ / "v.nvdb";
  std::string vdb_ = directory_ / "v.vdb";
};

TEST_F(ExportCommand, EveryKindOfVolumeBitForBit) {
  struct Case {
    const char* kind;
    const char* dims;
    std::vector<std::string> options;
  };
  const std::vector<Case> cases{
      {"noise", "1,1,1", {}},                         // one voxel
      {"turbulence", "150,100,40", {"--rate", "2"}},  // extents that end inside leaves
      {"turbulence", "140,90,70", {"--rate", "9", "--encoding", "fpn"}},
      {"signed", "96,200,130", {"--preset", "paper"}},                 // dropped blocks are background
      {"zero", "300,20,20", {}},                                       // tiles and the two corner leaves
      {"constant", "4100,8,8", {"--lossless"}},                        // two root entries
      {"sphere", "257,129,140", {"--rate", "10", "--metric", "sse"}},  // tiles of 128^3
      {"some-nan", "97,20,10", {"--lossless", "--nonfinite", "keep"}},
      {"huge", "64,64,64", {"--rate", "2"}},
      {"noise", "9,3,1", {"--size", "999999", "--encoding", "fpn"}},  // mostly padding
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(cat(c.kind, ' ', c.dims));
    sample(c.kind, c.dims, c.options);
    const nlohmann::json report = exported();
    const NvdbFile file(nvdb_);
    EXPECT_EQ(test::difference(file.grid(), vdb_), "");
    EXPECT_EQ(report["active_voxels"], file.grid().active_voxels());
    EXPECT_EQ(report["bytes"], std::filesystem::file_size(vdb_));
  }
}

// The centre of voxel (0, 0, 0), as OpenVDB's map takes an index: both files have --origin there.
TEST_F(ExportCommand, Origin_IsWhereOpenVdbHasTheCentreOfVoxel0) {
  sample("turbulence", "9,8,7", {"--spacing", "2,4,8", "--origin", "10,20,30", "--roi", "1:9,0:8,0:7"});
  exported();
  EXPECT_EQ(NvdbFile(nvdb_).grid().world_origin(), (std::array<double, 3>{10, 20, 30}));
  EXPECT_EQ(test::read_facts(vdb_).origin, (std::array<double, 3>{10, 20, 30}));
}

TEST_F(ExportCommand, ConvertedBack_IsLossless) {
  sample("turbulence", "130,100,90", {"--rate", "4", "--spacing", "0.5,0.25,2", "--origin", "1,2,3"});
  exported({"--compression", "zip"});
  const CommandResult compared = run_weir({"compare", vdb_, nvdb_, "--json"});
  ASSERT_EQ(compared.exit_code, 0) << compared.err;
  const auto comparison = nlohmann::json::parse(compared.out);
  EXPECT_EQ(comparison["different"], 0);
  EXPECT_EQ(comparison["voxels"], 130 * 100 * 90);
  const std::string again = directory_ / "again.nvdb";
  const CommandResult converted = run_weir({"convert", vdb_, "-o", again, "--lossless"});
  ASSERT_EQ(converted.exit_code, 0) << converted.err;
  const NvdbFile first(nvdb_);
  const NvdbFile second(again);
  EXPECT_EQ(second.grid().index_bbox(), first.grid().index_bbox());
  EXPECT_EQ(second.grid().matrix(), first.grid().matrix());
  EXPECT_EQ(second.grid().world_origin(), first.grid().world_origin());
}

TEST_F(ExportCommand, LevelSetOfOpenVdb_StaysOneWithItsBackgroundAndPlace) {
  const std::string source = directory_ / "source.vdb";
  test::OpenVdbGrid grid(test::GridKind::float32, "distance");  // of background 2
  grid.fill({{-9, 2, -3}, {12, 20, 15}}, 0).set_on({0, 5, 5}, 1).place({1, 2, -3}, {10, 20, 30}).class_is("level set");
  test::write_vdb(source, {grid});
  for (const char* encoding : {"float", "packed"}) {
    SCOPED_TRACE(encoding);
    convert(source, "", {"--encoding", encoding, "--lossless"});
    EXPECT_EQ(NvdbFile(nvdb_).grid().background(), 2.0F);
    exported();
    const test::VdbFacts facts = test::read_facts(vdb_);
    EXPECT_EQ(facts.metadata.at("class"), "level set");
    EXPECT_EQ(facts.origin[2] + -3 * facts.steps[2][2], 39) << "z of the first voxel, 30 + -3 * -3";
  }
}

TEST_F(ExportCommand, ARealCloudIsReadByTheStockTool) {
  const std::string cloud = std::string(WEIR_SOURCE_DIR) + "/../shared/data/wdas_cloud_sixteenth.vdb";
  if (!std::filesystem::exists(cloud)) GTEST_SKIP() << cloud << " is missing";
  convert(cloud, "", {"--lossless"});
  exported();
  const CommandResult compared = run_weir({"compare", cloud, nvdb_});
  EXPECT_EQ(compared.out, "lossless: all 1668744 finite voxels read bit for bit\n") << compared.err;
  EXPECT_EQ(test::difference(NvdbFile(nvdb_).grid(), vdb_), "");
  if (run_command({"sh", "-c", "command -v vdb_print"}).exit_code != 0) {
    GTEST_SKIP() << "vdb_print is not installed (package libopenvdb-tools)";
  }
  const CommandResult printed = run_command({"vdb_print", vdb_});
  EXPECT_EQ(printed.exit_code, 0) << printed.err;
  // Name, type, bounding box, dimensions.
  const std::regex row(R"(density +float +\(-66,-21,-90\)->\(59,64,63\) +126x86x154 )");
  EXPECT_TRUE(std::regex_search(printed.out, row)) << printed.out;
}

TEST_F(ExportCommand, CertificateIsWrittenAsMetadata) {
  sample("turbulence", "130,100,90", {"--rate", "10"});
  exported();
  const auto sidecar = nlohmann::json::parse(read_file(nvdb_ + ".json"));
  const auto metadata = test::read_facts(vdb_).metadata;
  EXPECT_EQ(metadata.at("weir_source_path"), raw_);
  EXPECT_EQ(metadata.at("weir_source_format"), "raw");
  EXPECT_EQ(metadata.at("weir_budget"), "rate");
  EXPECT_EQ(metadata.at("weir_requested"), "10");
  EXPECT_EQ(metadata.at("weir_lossless"), "false");
  EXPECT_NEAR(std::stod(metadata.at("weir_psnr_db")), sidecar["error"]["psnr_db"].get<double>(), 1e-3);
  EXPECT_NEAR(std::stod(metadata.at("weir_max_abs")), sidecar["error"]["max_abs"].get<double>(), 1e-5);
  EXPECT_NEAR(std::stod(metadata.at("weir_rmse")), sidecar["error"]["rmse"].get<double>(), 1e-6);
  EXPECT_EQ(metadata.at("weir_version"), sidecar["weir"]["version"].get<std::string>());
  EXPECT_EQ(metadata.count("weir_half_max_abs_error"), 0U);

  nlohmann::json other = sidecar;
  other["file"]["head_checksum"] = "12345678";
  for (const auto& [text, message] :
       {std::pair{other.dump(), "is of another volume than " + nvdb_ + "; its certificate is left out"},
        {std::string("no"), std::string("at byte 1: not valid JSON; write the sidecar again with weir convert; the "
                                        "certificate is left out")}}) {
    write_file(nvdb_ + ".json", text);
    const CommandResult result = run_weir({"export", nvdb_, "-o", vdb_, "--overwrite"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.err.find(nvdb_ + ".json: " + message), std::string::npos) << result.err;
    EXPECT_EQ(test::read_facts(vdb_).metadata.count("weir_rmse"), 0U);
  }
}

TEST_F(ExportCommand, LosslessFileThatIsRoundedToHalf_IsLosslessNoMore) {
  sample("turbulence", "40,40,40", {"--lossless"});
  exported();
  EXPECT_EQ(test::read_facts(vdb_).metadata.at("weir_lossless"), "true");
  const CommandResult half = run_weir({"export", nvdb_, "-o", vdb_, "--overwrite", "--half"});
  ASSERT_EQ(half.exit_code, 0) << half.err;
  EXPECT_EQ(test::read_facts(vdb_).metadata.at("weir_lossless"), "false");
}

TEST_F(ExportCommand, HalfReportsItsLargestError) {
  sample("turbulence", "130,100,90", {"--rate", "4"});
  const nlohmann::json report = exported({"--half"});
  double worst = 0;
  const NvdbFile file(nvdb_);
  EXPECT_EQ(test::difference(file.grid(), vdb_,
                             [&](float value) {
                               const float half = rounded_to_half(value);
                               worst = std::max(worst, std::abs(static_cast<double>(half) - value));
                               return half;
                             }),
            "");
  EXPECT_EQ(report["half_max_abs_error"].get<double>(), worst);
  const CommandResult text = run_weir({"export", nvdb_, "-o", vdb_, "--overwrite", "--half"});
  EXPECT_NE(text.out.find(cat("\nlargest error of 16 bits: ", worst, '\n')), std::string::npos) << text.out;
  EXPECT_TRUE(exported()["half_max_abs_error"].is_null());
}

TEST_F(ExportCommand, ReportOfANameWithANewlineIsOneLine) {
  sample("sphere", "20,20,20", {"--lossless"});
  const TemporaryDirectory directory;
  const CommandResult result = run_weir({"export", nvdb_, "-o", directory / "two\nlines.vdb"});
  EXPECT_TRUE(result.out.starts_with(directory / "two\\nlines.vdb: ")) << result.out;
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 1);
}

TEST_F(ExportCommand, SameBytesWhateverTheThreads) {
  sample("turbulence", "200,150,130", {"--rate", "3"});
  exported({"--threads", "1"});
  const std::string first = read_file(vdb_);
  exported({"--threads", "5", "--memory", "1GiB"});
  EXPECT_EQ(read_file(vdb_), first);
}

TEST_F(ExportCommand, MemoryDoesNotGrowWithTheVolume) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  constexpr std::uint64_t kCeiling = std::uint64_t{80} << 20U;
  sample("noise", "300,300,300", {"--lossless"});
  ASSERT_GT(std::filesystem::file_size(nvdb_), kCeiling);
  for (const std::string compression : {"none", "blosc"}) {
    std::vector<std::string> arguments{"export",        nvdb_,       "-o",       vdb_,    "--overwrite",
                                       "--compression", compression, "--memory", "80MiB", "--json"};
    const CommandResult result = run_weir(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const nlohmann::json report = nlohmann::json::parse(result.out);
    EXPECT_LT(report["peak_rss_bytes"], kCeiling) << compression;
    EXPECT_GT(report["tree_bytes"], kCeiling);
  }
}

TEST_F(ExportCommand, InterruptedItLeavesNothing) {
  sample("noise", "300,300,200", {"--lossless"});
  ChildProcess child({WEIR_COMMAND, "export", nvdb_, "-o", vdb_, "--compression", "zip", "--threads", "1"});
  const std::filesystem::path partial = vdb_ + ".partial";
  std::error_code absent;
  const auto begun = [&] {
    const auto bytes = std::filesystem::file_size(partial, absent);
    return !absent && bytes > 0;
  };
  while (child.running() && !begun()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_TRUE(child.running());
  child.send_signal(SIGINT);
  const CommandResult result = child.wait();
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_EQ(result.err, "weir: interrupted\n");
  EXPECT_EQ(list_directory(directory_.path()), (std::vector<std::string>{"v.nvdb", "v.nvdb.json", "v.raw"}));
}

TEST_F(ExportCommand, OnlyTheFirstOfSeveralGrids) {
  test::write_whole(nvdb_, test::StockNvdb(GridType::float32).file_of_two());
  const CommandResult result = run_weir({"export", nvdb_, "-o", vdb_});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find(nvdb_ + ": has 2 grids, and only the first, \"sample\", is exported"), std::string::npos);
  EXPECT_EQ(test::difference(NvdbFile(nvdb_).grid(), vdb_), "");
}

TEST_F(ExportCommand, Refusals) {
  sample("huge", "20,20,20", {"--lossless"});
  expect_refused({"export", nvdb_, "-o", directory_ / "v.usd"}, 2,
                 "--output is \"" + (directory_ / "v.usd") + "\", it must end in .vdb");
  expect_refused({"export", nvdb_, "-o", vdb_, "--memory", "1MiB"}, 2,
                 "--memory is \"1MiB\", it must be a size of at least 64.0 MiB, like 512MiB");
  expect_refused({"export", directory_ / "none.nvdb", "-o", vdb_}, 3,
                 (directory_ / "none.nvdb") + ": cannot open: No such file or directory");
  expect_refused({"export", raw_, "-o", vdb_}, 3,
                 raw_ + ": is no NanoVDB file; convert it first: weir convert " + raw_);
  expect_refused({"export", nvdb_, "-o", directory_ / "no/v.vdb"}, 5,
                 (directory_ / "no/v.vdb") + ": the directory " + (directory_ / "no") +
                     " does not exist; make it or choose another output");
  const CommandResult half = run_weir({"export", nvdb_, "-o", vdb_, "--half"});
  EXPECT_EQ(half.exit_code, 2);
  EXPECT_TRUE(std::regex_search(half.err, std::regex("v\\.nvdb: --half holds values up to 65504, and one is .*; leave "
                                                     "--half out\n$")))
      << half.err;
  EXPECT_FALSE(std::filesystem::exists(vdb_));
  exported();
  expect_refused({"export", nvdb_, "-o", vdb_}, 2, vdb_ + ": exists; choose another output or pass --overwrite");
  EXPECT_EQ(list_directory(directory_.path()), (std::vector<std::string>{"v.nvdb", "v.nvdb.json", "v.raw", "v.vdb"}));
}

TEST_F(ExportCommand, FullDisk_OffersAnotherOutputAlone) {
  sample("turbulence", "64,64,64", {"--lossless", "--encoding", "float"});
  const std::filesystem::path full = directory_.path() / "full";
  std::filesystem::create_directory(full);
  const ScopedMount mount(full, 1 << 16);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  const CommandResult result = run_weir({"export", nvdb_, "-o", full / "v.vdb", "--compression", "none"});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_TRUE(
      result.err.ends_with(": No space left on device; free space on that file system or choose another with -o\n"))
      << result.err;
}

}  // namespace
}  // namespace weir::export_test
