// Tests weir inspect as a user runs it.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "format/base/text.h"
#include "format/layout/nanovdb_layout.h"
#include "tests/support/unreadable_file.h"
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

TEST_F(Inspect, BackgroundThatWasGiven_HasNoShare) {
  EXPECT_NE(run_weir({"inspect", volume_}).out.find("\nbackground  0, mode, 50"), std::string::npos);
  const std::string given = directory_ / "given.nvdb";
  ASSERT_EQ(run_weir({"convert", volume_, "-o", given, "--background", "0", "-q"}).exit_code, 0);
  const CommandResult text = run_weir({"inspect", given});
  EXPECT_NE(text.out.find("\nbackground  0, user\n"), std::string::npos) << text.out;
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

TEST_F(Inspect, PlotThatIsTheVolumeOrItsSidecar_IsRefused) {
  const std::string named = directory_ / "v.png";
  fs::copy_file(volume_, named);
  fs::create_hard_link(sidecar_path(volume_), directory_ / "s.png");
  const std::string before = read_file(named);
  const CommandResult of_volume = run_weir({"inspect", named, "--plot", named});
  EXPECT_EQ(of_volume.exit_code, 2);
  EXPECT_EQ(of_volume.err, cat("weir: ", named, ": belongs to the input, and writing ", named,
                               " would replace or remove it; choose another output\n"));
  EXPECT_EQ(read_file(named), before);
  EXPECT_EQ(run_weir({"inspect", volume_, "--plot", directory_ / "s.png"}).exit_code, 2);
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

TEST_F(Inspect, HistogramWithoutSidecar_IsOfTheFiniteValues) {
  const auto histogram = [&](std::vector<float> values) {
    const std::string raw = directory_ / "v_8x8x8_float32.raw";
    values.resize(512, 0.5F);
    write_file(raw, {reinterpret_cast<const char*>(values.data()), 4 * values.size()});
    const std::string made = directory_ / "v.nvdb";
    const CommandResult converted = run_weir(
        {"convert", raw, "-o", made, "--overwrite", "--lossless", "--encoding", "float", "--nonfinite", "keep"});
    EXPECT_EQ(converted.exit_code, 0) << converted.err;
    fs::remove(sidecar_path(made));
    return nlohmann::json::parse(run_weir({"inspect", made, "--json", "--progress", "never"}).out)["histogram"];
  };
  const nlohmann::json one_value = histogram({});
  EXPECT_EQ(one_value["min"], 0.5);
  EXPECT_EQ(one_value["max"], 0.5);
  EXPECT_EQ(one_value["counts"], nlohmann::json({512}));
  const nlohmann::json with_infinity = histogram({INFINITY, 0.25F, 0.25F, NAN});
  EXPECT_EQ(with_infinity["min"], 0.25);
  EXPECT_EQ(with_infinity["max"], 0.5);
  EXPECT_EQ(with_infinity["counts"].front(), 2);
  EXPECT_EQ(with_infinity["counts"].back(), 508);
  for (const float value : {NAN, INFINITY, -INFINITY}) {
    const nlohmann::json none = histogram(std::vector<float>(512, value));
    EXPECT_EQ(none["counts"].size(), 0U) << value;
    EXPECT_TRUE(none["min"].is_null() && none["max"].is_null()) << value;
  }
}

// A file as left by a writer that computes no statistics.
TEST_F(Inspect, FileWithoutStatistics_HasTheRangeOfItsBlocks) {
  fs::remove(sidecar_path(volume_));
  const auto range = [&] {
    const auto report = nlohmann::json::parse(run_weir({"inspect", volume_, "--json", "--progress", "never"}).out);
    EXPECT_GT(report["histogram"]["counts"].size(), 1U);
    return report["grid"]["value_range"];
  };
  const nlohmann::json stored = range();
  std::string bytes = read_file(volume_);
  const std::uint64_t at = open().grid().grid_offset() + nvdb::grid::kFlags;
  bytes[at] = static_cast<char>(bytes[at] & ~static_cast<int>(nvdb::grid::kFlagMinMax));
  write_file(volume_, bytes);
  EXPECT_EQ(range(), stored);
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

TEST_F(Inspect, FileThatCannotBeRead_HidesNoOther) {
  const std::string bad = directory_ / "a.nvdb";
  write_file(bad, "no volume");
  const CommandResult text = run_weir({"inspect", bad, volume_, directory_ / "v_40x30x20_float32.raw"});
  EXPECT_EQ(text.exit_code, 3);
  EXPECT_EQ(text.out.find("file        " + volume_ + '\n'), 0U) << text.out;
  EXPECT_NE(text.out.find("\n\n" + (directory_ / "v_40x30x20_float32.raw")), std::string::npos) << text.out;
  EXPECT_EQ(text.err.find("weir: " + bad + ": "), 0U) << text.err;
  EXPECT_EQ(text.err.find('\n'), text.err.size() - 1) << text.err;
  const CommandResult json = run_weir({"inspect", bad, volume_, "--json"});
  EXPECT_EQ(json.exit_code, 3);
  const auto files = nlohmann::json::parse(json.out)["files"];
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0]["path"], bad);
  EXPECT_EQ("weir: " + files[0]["error"].get<std::string>() + '\n', json.err);
  EXPECT_EQ(files[1]["grid"]["type"], "float32");
}

TEST_F(Inspect, SidecarThatCannotBeRead_HidesNoVolume) {
  write_file(sidecar_path(volume_), "{");
  const std::string why = sidecar_path(volume_) + ": at byte ";
  const CommandResult text = run_weir({"inspect", volume_});
  EXPECT_EQ(text.exit_code, 3);
  EXPECT_NE(text.out.find("\nsidecar     unreadable: " + why), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("grid        \"density\" float32, 40 x 30 x 20 voxels"), std::string::npos) << text.out;
  EXPECT_EQ(text.err.find("weir: " + why), 0U) << text.err;
  const CommandResult json = run_weir({"inspect", volume_, "--json"});
  EXPECT_EQ(json.exit_code, 3);
  const auto report = nlohmann::json::parse(json.out);
  EXPECT_EQ(report["grid"]["type"], "float32");
  EXPECT_EQ(report["sidecar"], nullptr);
  EXPECT_EQ(report["sidecar_error"].get<std::string>().find(why), 0U);
}

TEST_F(Inspect, SidecarThatTheSystemDoesNotGive_ExitsWith5) {
  const std::string unreadable = unreadable_file();
  if (unreadable.empty()) GTEST_SKIP() << "this system has no file that root cannot read";
  fs::remove(sidecar_path(volume_));
  fs::create_symlink(unreadable, sidecar_path(volume_));
  const CommandResult text = run_weir({"inspect", volume_});
  EXPECT_EQ(text.exit_code, 5);
  EXPECT_EQ(text.err, "weir: " + sidecar_path(volume_) + ": cannot read the sidecar; check the permissions\n");
  EXPECT_EQ(run_weir({"verify", volume_}).exit_code, 5) << "the same of both";
}

TEST_F(Inspect, DrawsTheHistogram_WhereTheSidecarCannotBeRead) {
  write_file(sidecar_path(volume_), "{");
  EXPECT_EQ(run_weir({"inspect", volume_, "--json", "--plot", directory_ / "h.svg"}).exit_code, 3);
  EXPECT_TRUE(read_file(directory_ / "h.svg").starts_with("<?xml"));
}

TEST_F(Inspect, OptionsThatItCannotHonour_AreRefused) {
  const auto refusal = [](const std::vector<std::string>& words) {
    const CommandResult result = run_weir(words);
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  };
  const std::string raw = directory_ / "v_40x30x20_float32.raw";
  EXPECT_EQ(refusal({"inspect", volume_, "--dims", "3,3,3"}),
            "weir: --dims says how to read a source, and " + volume_ + " is a .nvdb file; leave it out\n");
  for (const std::string option : {"index", "component", "magnitude", "levels", "roi", "ghost"}) {
    EXPECT_EQ(refusal({"inspect", raw, "--" + option, "0"}).find("weir: no option --" + option + ';'), 0U) << option;
  }
  EXPECT_EQ(refusal({"inspect", raw, "--level", "3"}),
            "weir: " + raw + ": --level is for AMReX plotfiles, and this is raw; leave it out\n");
  EXPECT_EQ(refusal({"inspect", raw, "--dataset", "rho"}),
            "weir: " + raw + ": lists no dataset for --dataset rho; it has one volume without a name\n");
}

TEST_F(Inspect, AResultThatALinkLeadsTo_HasItsSidecar) {
  const std::string link = directory_ / "link.nvdb";
  fs::create_symlink(volume_, link);
  const auto report = nlohmann::json::parse(run_weir({"inspect", link, "--json"}).out);
  EXPECT_EQ(report["sidecar_matches"], true);
  const CommandResult verified = run_weir({"verify", link});
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
}

}  // namespace
}  // namespace weir::inspect_test
