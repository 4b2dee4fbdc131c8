// weir inspect as a user runs it.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/tools/support/converted_volume.h"

namespace weir::inspect_test {
namespace {

namespace fs = std::filesystem;

using Inspect = ConvertedVolume;

TEST_F(Inspect, ShowsVolumeAndCertificate) {
  const CommandResult text = run_weir({"inspect", volume_});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_EQ(text.err, "");
  EXPECT_NE(text.out.find("450001 bytes (439.5 KiB), grid at 4096, "), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("grid        \"density\" float32, 40 x 30 x 20 voxels from (0, 0, 0)\n"), std::string::npos);
  EXPECT_NE(text.out.find("budget      size 450001: 450001 of 96000 bytes"), std::string::npos) << text.out;
  const auto report = nlohmann::json::parse(run_weir({"inspect", volume_, "--json"}).out);
  EXPECT_EQ(report["file"]["head_checksum_state"], "ok");
  EXPECT_EQ(report["tree"]["active_voxels"], open().grid().active_voxels());
  EXPECT_EQ(report["sidecar"]["file"]["bytes"], 450001);
  EXPECT_EQ(report["sidecar_matches"], true);
}

TEST_F(Inspect, TextThatSteersATerminal_IsOneLine) {
  auto record = nlohmann::ordered_json::parse(read_file(sidecar_path(volume_)));
  record["source"]["long_name"] = "l\nweir: fake";
  record["source"]["units"] = "K\x1b[31m";
  record["source"]["dataset"] = "/d\tata";
  write_file(sidecar_path(volume_), record.dump());
  const CommandResult text = run_weir({"inspect", volume_});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_EQ(text.out.find('\x1b'), std::string::npos) << text.out;
  EXPECT_EQ(text.out.find('\t'), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("\nquantity    l\\nweir: fake (K\\x1b[31m)\n"), std::string::npos) << text.out;
}

TEST_F(Inspect, DrawsTheHistogramAsPngAndSvg) {
  for (const auto& [name, begin] : {std::pair{"h.png", "\x89PNG"}, std::pair{"h.svg", "<?xml"}}) {
    const CommandResult result = run_weir({"inspect", volume_, "--plot", directory_ / name});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(read_file(directory_ / name).starts_with(begin)) << name;
  }
}

TEST_F(Inspect, WorksWithoutSidecar) {
  fs::remove(sidecar_path(volume_));
  const auto report = nlohmann::json::parse(run_weir({"inspect", volume_, "--json", "--progress", "never"}).out);
  EXPECT_TRUE(report["sidecar"].is_null());
  std::uint64_t voxels = 0;
  for (const auto& count : report["histogram"]["counts"]) voxels += count.get<std::uint64_t>();
  EXPECT_EQ(voxels, open().grid().active_voxels());
  const CommandResult bad = run_weir({"inspect", volume_, "--plot", directory_ / "h.jpg"});
  EXPECT_EQ(bad.exit_code, 2);
}

TEST_F(Inspect, AFileOfAnotherSuffixIsTheGridThatItHolds) {
  const std::string copy = directory_ / "result.grid";
  fs::copy_file(volume_, copy);
  const auto grid = [](const std::string& path) {
    return nlohmann::json::parse(run_weir({"inspect", path, "--json", "--progress", "never"}).out)["grid"];
  };
  EXPECT_FALSE(grid(volume_).is_null());
  EXPECT_EQ(grid(copy), grid(volume_));
}

TEST_F(Inspect, SeveralFilesAndPatterns_AreListedOneAfterTheOther) {
  fs::copy_file(volume_, directory_ / "step_0001.nvdb");
  fs::copy_file(volume_, directory_ / "step_0010.nvdb");
  for (const std::string pattern : {"step_*.nvdb", "step_%04d.nvdb"}) {
    const auto report =
        nlohmann::json::parse(run_weir({"inspect", directory_ / pattern, "--json", "--progress", "never"}).out);
    ASSERT_EQ(report["files"].size(), 2U) << pattern;
    EXPECT_EQ(report["files"][0]["path"], directory_ / "step_0001.nvdb");
    EXPECT_EQ(report["files"][1]["path"], directory_ / "step_0010.nvdb");
  }
  const CommandResult text = run_weir({"inspect", volume_, directory_ / "step_0001.nvdb", "--progress", "never"});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_NE(text.out.find("\n\nfile        " + volume_ + '\n'), std::string::npos) << text.out;
  const CommandResult plotted = run_weir({"inspect", directory_ / "*.nvdb", "--plot", directory_ / "h.png"});
  EXPECT_EQ(plotted.exit_code, 2);
  EXPECT_EQ(plotted.err, "weir: --plot draws one histogram, and 3 files are given; give one of them\n");
}

}  // namespace
}  // namespace weir::inspect_test
