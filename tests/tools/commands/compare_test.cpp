// Tests weir compare from outside, on files that the command itself made.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "format/base/text.h"
#include "tests/support/run_command.h"
#include "tests/support/sanitized.h"
#include "tests/tools/support/converted_pair.h"
#include "tools/spectrum/block_transform.h"

namespace weir::compare_test {
namespace {

TEST(Compare, LosslessFile) {
  const ConvertedPair volume("cloud", "70x45x37_float32", {"--lossless"});
  nlohmann::json report = volume.compare();
  EXPECT_EQ(report["source"], volume.raw);
  EXPECT_EQ(report["volume"], volume.nvdb);
  EXPECT_GT(report["total_s"], 0.0);
  EXPECT_GT(report["peak_rss_bytes"], 1000000);
  for (const char* varies : {"source", "volume", "total_s", "peak_rss_bytes", "value_range", "zeros"})
    report.erase(varies);
  EXPECT_EQ(report, nlohmann::json::parse(R"({"mse": 0.0, "rmse": 0.0, "nmse": 0.0, "psnr_db": null, "max_abs": 0.0,
      "lossless": true, "max_abs_at": null, "voxels": 116550, "finite": 116550, "nonfinite": 0,
      "nonfinite_decoded": 0, "different": 0, "nonfinite_different": 0, "missing": 0, "zeros_lost": 0,
      "conversion_loss": {"inexact": 0, "overflow": 0, "max_abs_error": 0.0}})"));
  EXPECT_EQ(run_weir({"compare", volume.raw, volume.nvdb}).out,
            "lossless: all 116550 finite voxels read bit for bit\n");
}

// Returns the text behind `key` and blanks, on its line.
std::string line_of(const std::string& text, const std::string& key) {
  const std::size_t at = ("\n" + text).find("\n" + key + ' ');
  if (at == std::string::npos) return "no line " + key;
  const std::size_t begin = text.find_first_not_of(' ', at + key.size());
  return text.substr(begin, text.find('\n', begin) - begin);
}

TEST(Compare, SaysOfTheGradientWhatTheConversionCertified) {
  const TemporaryDirectory directory;
  const std::string raw = directory / "a_50x45x37_float32.raw";
  const std::string nvdb = directory / "a.nvdb";
  ASSERT_EQ(run_weir({"sample", "turbulence", "-o", raw}).exit_code, 0);
  const CommandResult made =
      run_weir({"convert", raw, "-o", nvdb, "--psnr", "40", "--spacing", "1,1,2", "--certify", "gradient", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const CommandResult compared = run_weir({"compare", raw, nvdb, "--derived"});
  ASSERT_EQ(compared.exit_code, 0) << compared.err;
  EXPECT_TRUE(compared.err.ends_with(cat(" info ", raw, ": read with --spacing 1,1,2, as ", nvdb, ".json records\n")))
      << compared.err;
  const std::string said = line_of(compared.out, "gradient");
  EXPECT_EQ(said.substr(0, 13), "relative rms ");
  EXPECT_EQ(line_of(run_weir({"inspect", nvdb}).out, "gradient"), said);
  EXPECT_NE(made.err.find(", gradient: " + said + ','), std::string::npos) << made.err;
  const auto certified = nlohmann::json::parse(made.out)["error"]["gradient"];
  const auto report = nlohmann::json::parse(run_weir({"compare", raw, nvdb, "--derived", "--json"}).out);
  EXPECT_EQ(certified, report["derived"]["gradient"]);
  EXPECT_GT(certified["rms"], 0.0);
  const CommandResult other = run_weir({"compare", raw, nvdb, "--spacing", "1,1,1"});
  EXPECT_TRUE(other.err.ends_with(cat(" warning ", nvdb, ": was converted with --spacing 1,1,2, as ", nvdb,
                                      ".json records, and is compared with --spacing 1,1,1\n")))
      << other.err;
}

TEST(Compare, VoxelSizeOfTheVolume_CountsWithoutASidecar) {
  const ConvertedPair volume("turbulence", "30x25x17_float32", {"--psnr", "40", "--spacing", "0.5,0.5,2"});
  const std::vector<std::string> words{"compare", volume.raw, volume.nvdb, "--derived", "--json"};
  const auto derived = [&](std::vector<std::string> more) {
    more.insert(more.begin(), words.begin(), words.end());
    return nlohmann::json::parse(run_weir(more).out)["derived"]["gradient"];
  };
  const auto recorded = derived({});
  std::filesystem::remove(volume.nvdb + ".json");
  EXPECT_EQ(derived({}), recorded);
  EXPECT_EQ(derived({"--spacing", "0.5,0.5,2"}), recorded);
  EXPECT_LT(derived({"--spacing", "1,1,4"})["rms"], recorded["rms"]) << "what is given counts";
  const CommandResult said = run_weir(words);
  EXPECT_TRUE(said.err.ends_with(
      cat(" info ", volume.raw, ": taken with --spacing 0.5,0.5,2, the voxel size of ", volume.nvdb, '\n')))
      << said.err;
  EXPECT_EQ(run_weir({"compare", volume.raw, volume.nvdb}).err, "") << "no length counts";
}

// The file has -Infinity where the source is 2, and in 1 of 100 further voxels; the error is over the other 1799
// voxels.
TEST(Compare, VoxelsThatTheFileReadsAsInfinite_AreLeftOutOfTheError) {
  const TemporaryDirectory directory;
  const std::string raw = directory / "a_20x10x9_float32.raw";
  const std::string nvdb = directory / "a.nvdb";
  std::vector<float> values(1800, 2.0F);
  values[7] = -std::numeric_limits<float>::infinity();
  const auto write = [&] { write_file(raw, {reinterpret_cast<const char*>(values.data()), 4 * values.size()}); };
  write();
  const CommandResult made = run_weir({"convert", raw, "-o", nvdb, "--lossless", "--nonfinite", "keep"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  values[7] = 2;
  for (std::size_t i = 100; i < 200; ++i) values[i] = 3;
  write();
  const CommandResult said = run_weir({"compare", raw, nvdb, "--json"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  const auto report = nlohmann::json::parse(said.out);
  EXPECT_EQ(report["mse"], 100.0 / 1799);
  EXPECT_EQ(report["nonfinite_decoded"], 1);
  EXPECT_EQ(report["different"], 101);
  EXPECT_EQ(report["lossless"], false);
  EXPECT_NEAR(report["psnr_db"], 10 * std::log10(17.99), 1e-9);
  const std::string text = run_weir({"compare", raw, nvdb}).out;
  EXPECT_TRUE(text.ends_with("not finite 1 voxels of the file where the source is finite, left out of the error\n"))
      << text;
}

TEST(Compare, SpectrumIsAskedForByTheEndingOfItsFile) {
  const ConvertedPair volume("turbulence", "40x30x20_float32", {"--psnr", "40"});
  const std::string table = volume.directory / "a.csv";
  const auto spectrum = [&](const std::string& path) {
    return run_weir({"compare", volume.raw, volume.nvdb, "--spectrum", path});
  };
  if (!has_fftw()) {
    EXPECT_EQ(spectrum(table).err,
              "weir: --spectrum: this weir was built without FFTW; build it with -DWEIR_FFTW=ON\n");
    return;
  }
  EXPECT_EQ(spectrum("a.txt").err, "weir: --spectrum is \"a.txt\", it must be FILE.png, FILE.svg or FILE.csv\n");
  EXPECT_EQ(spectrum(volume.directory / "none/a.csv").exit_code, 5);
  const CommandResult drawn = spectrum(table);
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_TRUE(line_of(drawn.out, "spectrum").ends_with("; 1 block of 40 x 30 x 20 voxels")) << drawn.out;
  EXPECT_EQ(read_file(table).substr(0, 39), "wave_number,modes,source,decoded,error\n");
}

TEST(Compare, SpectrumThatIsAnInput_IsRefused) {
  if (!has_fftw()) GTEST_SKIP() << "this weir was built without FFTW";
  const ConvertedPair volume("turbulence", "40x30x20_float32", {"--psnr", "40"});
  const std::string source = volume.directory / "v.csv";
  std::filesystem::copy_file(volume.raw, source);
  const std::string before = read_file(source);
  const CommandResult refused =
      run_weir({"compare", source, volume.nvdb, "--dims", "40,30,20", "--type", "float32", "--spectrum", source});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err, cat("weir: ", source, ": belongs to the input, and writing ", source,
                             " would replace or remove it; choose another output\n"));
  EXPECT_EQ(read_file(source), before);
}

TEST(Compare, SpectrumReplacesTheOneBefore_AsTheHelpSays) {
  const std::string help = run_weir({"compare", "--help"}).out;
  EXPECT_NE(help.find("or a table, FILE.csv, which replaces one that is there; reads both once more\n"),
            std::string::npos)
      << help;
  if (!has_fftw()) return;
  const ConvertedPair volume("turbulence", "40x30x20_float32", {"--psnr", "40"});
  const std::string table = volume.directory / "a.csv";
  write_file(table, "another");
  const CommandResult refused = run_weir({"compare", volume.raw, volume.nvdb, "--spectrum", table, "--trace", table});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err, "weir: --trace " + table + ": is an input or an output; choose another\n");
  EXPECT_EQ(read_file(table), "another");
  EXPECT_EQ(run_weir({"compare", volume.raw, volume.nvdb, "--spectrum", table}).exit_code, 0);
  EXPECT_EQ(read_file(table).substr(0, 39), "wave_number,modes,source,decoded,error\n");
}

TEST(Compare, ErrorsOfVorticityAndDivergenceOfThreeComponents) {
  const ConvertedPair first("turbulence", "20x18x17_float32", {"--psnr", "30"});
  const ConvertedPair lossless("noise", "20x18x17_float32", {"--lossless"});
  const CommandResult said = run_weir(
      {"compare", first.raw, first.nvdb, "--vector", lossless.raw, lossless.nvdb, lossless.raw, lossless.nvdb});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(line_of(said.out, "vorticity").substr(0, 10), "rms error ");
  EXPECT_EQ(line_of(said.out, "divergence").substr(0, 10), "rms error ");
  EXPECT_TRUE(said.out.ends_with(" per world unit\n")) << said.out;
  const ConvertedPair other("noise", "20x18x16_float32", {"--lossless"});
  const CommandResult refused =
      run_weir({"compare", first.raw, first.nvdb, "--vector", lossless.raw, lossless.nvdb, other.raw, other.nvdb});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(refused.err.substr(0, refused.err.find(": holds the voxels")), "weir: " + other.raw);
}

TEST(Compare, OneVoxelChangedSinceTheConversion) {
  const ConvertedPair volume("zero", "20x10x9_float32", {"--lossless"});
  std::string bytes = read_file(volume.raw);
  const float value = 1.5F;
  std::memcpy(bytes.data() + 4 * (7 + 20 * (3 + 10 * 8)), &value, 4);
  write_file(volume.raw, bytes);
  const nlohmann::json report = volume.compare();
  EXPECT_EQ(report["mse"], 2.25 / 1800);
  EXPECT_EQ(report["max_abs"], 1.5);
  EXPECT_EQ(report["max_abs_at"], (nlohmann::json{7, 3, 8}));
  EXPECT_EQ(report["different"], 1);
  EXPECT_EQ(report["lossless"], false);
  EXPECT_EQ(report["value_range"], (nlohmann::json{0.0, 1.5}));
  const CommandResult text = run_weir({"compare", volume.raw, volume.nvdb});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_EQ(text.out,
            "mse        0.00125\nrmse       0.03536\nnmse       0.0005556\npsnr       32.55 dB\n"
            "max abs    1.5 (100 % of the range) at 7,3,8\ndifferent  1 of 1800 finite voxels\n");
}

TEST(Compare, EqualsTheCertificate) {
  for (const std::string kind : {"cloud", "turbulence", "huge", "tiny", "offset", "background", "plateau"}) {
    const ConvertedPair volume(kind, "100x90x80_float32", {"--rate", "4"});
    const nlohmann::json report = volume.compare();
    const nlohmann::json certificate = nlohmann::json::parse(read_file(volume.nvdb + ".json"))["error"];
    for (const char* key : {"mse", "rmse", "nmse", "max_abs"}) {
      const auto expected = certificate[key].get<double>();
      EXPECT_NEAR(report[key].get<double>(), expected, 1e-9 * expected) << kind << ' ' << key;
    }
    EXPECT_EQ(report["lossless"], certificate["lossless"]) << kind;
    EXPECT_EQ(report["psnr_db"].is_null(), certificate["psnr_db"].is_null()) << kind;
  }
}

TEST(Compare, SameResultWhateverMemoryAndThreads) {
  const ConvertedPair volume("turbulence", "200x150x130_float32", {"--rate", "8"});
  nlohmann::json first = volume.compare({"--threads", "1", "--memory", "128MiB"});
  nlohmann::json second = volume.compare({"--threads", "5", "--memory", "2GiB", "--direct-io", "off"});
  for (const char* varies : {"total_s", "peak_rss_bytes"}) {
    first.erase(varies);
    second.erase(varies);
  }
  EXPECT_EQ(first, second);
}

TEST(Compare, TypesByteOrderAndRegion) {
  const ConvertedPair integers("turbulence", "60x50x40_int16be", {"--lossless"});
  EXPECT_EQ(integers.compare()["lossless"], true);
  const ConvertedPair region("noise", "60x50x40_float32", {"--lossless", "--roi", "3:50,0:50,9:31"});
  const nlohmann::json report = region.compare({"--roi", "3:50,0:50,9:31"});
  EXPECT_EQ(report["lossless"], true);
  EXPECT_EQ(report["voxels"], 47 * 50 * 22);
}

TEST(Compare, NonFiniteVoxelsAreCounted) {
  const ConvertedPair volume("some-nan", "97x10x10_float32", {"--lossless", "--nonfinite", "background"});
  const nlohmann::json report = volume.compare();
  EXPECT_EQ(report["nonfinite"], 300);
  EXPECT_EQ(report["nonfinite_different"], 300);
  EXPECT_EQ(report["finite"], 9400);
  EXPECT_EQ(report["lossless"], true);
  EXPECT_EQ(run_weir({"compare", volume.raw, volume.nvdb}).out,
            "lossless over valid voxels: all 9400 finite voxels read bit for bit\n"
            "not finite 300 voxels of the source, left out of the error; 300 of them read differently\n");
  const std::string help = run_weir({"compare", "--help"}).out;
  EXPECT_NE(help.find("its lossless is of the finite voxels, and nonfinite_different counts the others that read "
                      "differently\n"),
            std::string::npos)
      << help;
}

// The contract gives compare the input options of convert; the two options here are accepted and do not change the
// error.
TEST(Compare, PolicyAndSceneOfTheConversion_ChangeNoFigure) {
  const ConvertedPair volume("some-nan", "97x10x10_float32", {"--lossless", "--nonfinite", "background"});
  const std::string plain = run_weir({"compare", volume.raw, volume.nvdb}).out;
  for (const char* policy : {"error", "background", "keep"}) {
    const CommandResult said = run_weir({"compare", volume.raw, volume.nvdb, "--nonfinite", policy});
    EXPECT_EQ(said.out, plain) << policy;
    EXPECT_EQ(said.err, "") << policy;
  }
  EXPECT_EQ(run_weir({"compare", volume.raw, volume.nvdb, "--nonfinite", "drop"}).err,
            "weir: --nonfinite is \"drop\", it must be error, background or keep\n");
  const std::string scene = volume.directory / "s.toml";
  write_file(scene, "[volume]\nregion = [[0, 9], [0, 9], [0, 9]]\n");
  const CommandResult said = run_weir({"compare", volume.raw, volume.nvdb, "--scene", scene});
  EXPECT_EQ(said.out, plain);
  EXPECT_TRUE(said.err.ends_with(" info " + scene +
                                 ": changes no figure: they are of all voxels; weir inspect tells the error of what "
                                 "the conversion's scene shows\n"))
      << said.err;
  const CommandResult missing = run_weir({"compare", volume.raw, volume.nvdb, "--scene", scene + "x"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_EQ(missing.err, "weir: " + scene + "x: cannot read the scene; it must be an existing TOML file\n");
}

TEST(Compare, BoundedMemory) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const ConvertedPair volume("turbulence", "400x400x400_float32", {"--rate", "2"});  // 244 MiB, half of it leaves
  EXPECT_LT(volume.compare({"--memory", "128MiB"})["peak_rss_bytes"], std::uint64_t{128} << 20U);
}

TEST(Compare, Refusals) {
  const ConvertedPair volume("cloud", "20x10x9_float32", {"--lossless"});
  const auto refusal = [&](const std::vector<std::string>& arguments, int exit_code) {
    const CommandResult result = run_weir(arguments);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(result.out, "");
    return result.err;
  };
  EXPECT_EQ(refusal({"compare", volume.raw, volume.nvdb, "--roi", "0:20,0:10,0:8"}, 3),
            "weir: " + volume.nvdb + ": holds the voxels 0:20,0:10,0:9, " + volume.raw +
                " holds 0:20,0:10,0:8; give the source it was converted from, with the same --dims and --roi\n");
  EXPECT_EQ(refusal({"compare", volume.directory / "none.raw", volume.nvdb}, 3)
                .find("weir: " + (volume.directory / "none.raw")),
            0U);
  EXPECT_EQ(refusal({"compare", volume.raw, volume.directory / "none.nvdb"}, 3),
            "weir: " + (volume.directory / "none.nvdb") + ": cannot open: No such file or directory\n");
  EXPECT_EQ(refusal({"compare", volume.nvdb, volume.raw}, 3),
            "weir: " + volume.raw + ": is no NanoVDB file; give the source first, then the .nvdb file made of it\n");
  EXPECT_EQ(refusal({"compare", volume.raw, volume.nvdb, "--dims", "20,10,8"}, 2),
            "weir: " + volume.raw +
                ": --dims 20,10,8 contradicts the file's name, which says 20x10x9; drop it or rename the file\n");
  std::filesystem::create_symlink("loop", volume.directory / "loop");
  EXPECT_EQ(refusal({"compare", volume.raw, volume.directory / "loop"}, 3)
                .find("weir: " + (volume.directory / "loop") + ": cannot open: Too many levels"),
            0U);
  EXPECT_EQ(refusal({"compare", volume.raw}, 2), "weir: volume is required; see weir compare --help\n");
}

}  // namespace
}  // namespace weir::compare_test
