// Tests the conversion of an ocean model's output with a land mask. Missing values are refused, replaced or kept. All
// reports of weir about the file must agree about the missing values.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/python.h"
#include "tests/support/run_command.h"

namespace weir::missing_values_test {
namespace {

using Json = nlohmann::json;

// Writes 40 x 30 x 20 voxels. The first ten along x are land: 6000 of 24000 voxels.
constexpr const char* kOcean = R"(
import sys, os, numpy as np, h5py
os.chdir(sys.argv[1])
z, y, x = np.mgrid[0:20, 0:30, 0:40]
temperature = 15 + 10 * np.sin(x / 7.0) * np.cos(y / 5.0) - z / 4.0
land = x < 10
with h5py.File("ocean.nc", "w") as f:
    d = f.create_dataset("temp", data=np.where(land, 1e20, temperature).astype("f4"))
    d.attrs["_FillValue"] = np.float32(1e20)
with h5py.File("packed.nc", "w") as f:
    stored = np.round((temperature - 20) / 0.01)
    d = f.create_dataset("temp", data=np.where(land, -32767, stored).astype("i2"), chunks=(5, 10, 10), compression="gzip")
    d.attrs["_FillValue"] = np.int16(-32767)
    d.attrs["scale_factor"] = 0.01
    d.attrs["add_offset"] = 20.0
)";

class MissingValues : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
    ASSERT_TRUE(run_python(kOcean, directory_ / ""));
  }

  CommandResult convert(const std::vector<std::string>& options) {
    std::vector<std::string> all{"convert", input_, "-o", output_, "--overwrite"};
    all.insert(all.end(), options.begin(), options.end());
    return run_weir(all);
  }
  Json sidecar() { return Json::parse(read_file(output_ + ".json")); }

  const TemporaryDirectory directory_;
  const std::string input_ = directory_ / GetParam();
  const std::string output_ = directory_ / "ocean.nvdb";
  const bool packed_ = GetParam() == "packed.nc";
  const std::string fill_ = packed_ ? "-32767" : "1e+20";
};

TEST_P(MissingValues, ByDefault_AreRefusedWithCountPlaceAndOptions) {
  const CommandResult result = convert({"--lossless"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err, "weir: " + input_ + ", dataset /temp: 6000 of 24000 voxels (25 %) hold no data (stored as " +
                            fill_ + "), the first at 0,0,0; choose --missing-policy background or, to take " + fill_ +
                            " for data, --missing-policy keep\n");
  EXPECT_EQ(list_directory(directory_ / ""), (std::vector<std::string>{"ocean.nc", "packed.nc"}));
}

TEST_P(MissingValues, Background_IsSaidByConvertInspectVerifyAndCompare) {
  const CommandResult result = convert({"--lossless", "--missing-policy", "background"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string said = "6000 of 24000 voxels (25 %) hold no data and read as the background";
  EXPECT_NE(result.err.find(", lossless over valid voxels, " + said + ", "), std::string::npos) << result.err;
  const Json record = sidecar();
  EXPECT_EQ(record["missing"]["count"], 6000);
  EXPECT_EQ(record["missing"]["policy"], "background");
  EXPECT_EQ(record["nonfinite"]["count"], 0);
  EXPECT_LT(record["value_range"][1].get<double>(), 30);
  const std::string shown = run_weir({"inspect", output_}).out;
  EXPECT_NE(shown.find("\nmissing     " + said + "\n"), std::string::npos) << shown;
  EXPECT_NE(shown.find("\nerror       lossless over valid voxels: each of them as in the source\n"), std::string::npos)
      << shown;
  EXPECT_EQ(run_weir({"verify", output_}).exit_code, 0);
  EXPECT_EQ(run_weir({"compare", input_, output_}).out,
            "lossless over valid voxels: all 18000 valid voxels read bit for bit\n"
            "missing    6000 of 24000 voxels (25 %) hold no data, left out of the error\n");
}

TEST_P(MissingValues, LossyFile_PromisesTheBackgroundForExactBlocksOnly) {
  const std::string said =
      "6000 of 24000 voxels (25 %) hold no data; they read as the background, 12.5, only where a block is exact, and "
      "their error is not counted";
  for (const char* encoding : {"auto", "packed"}) {
    const CommandResult result =
        convert({"--psnr", "50", "--missing-policy", "background", "--background", "12.5", "--encoding", encoding});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find(" of the range), " + said + ", "), std::string::npos) << result.err;
    const std::string shown = run_weir({"inspect", output_}).out;
    EXPECT_NE(shown.find("\nmissing     " + said + "\n"), std::string::npos) << shown;
  }
}

// Missing voxels read as the background even if it lies outside the data's range and their block has valid voxels, too.
TEST_P(MissingValues, BackgroundBeyondTheValidRange_TakesTheirPlace) {
  ASSERT_TRUE(run_python(kOcean + std::string(R"(
for name, values in (("ocean.nc", temperature), ("packed.nc", stored * 0.01 + 20)):
    for bound, filled in (("low", -50), ("high", 100)):
        np.where(land, filled, values).astype("f4").tofile(name + "_" + bound + "_40x30x20_float32.raw")
)"),
                         directory_ / ""));
  for (const auto& [bound, background] : {std::pair("low", "-50"), std::pair("high", "100")}) {
    const std::string filled = input_ + "_" + bound + "_40x30x20_float32.raw";
    for (const char* encoding : {"auto", "packed"}) {
      SCOPED_TRACE(std::string(bound) + ", " + encoding);
      const std::vector<std::string> policy{"--missing-policy", "background", "--background",
                                            background,         "--encoding", encoding};
      std::vector<std::string> options{"--lossless"};
      options.insert(options.end(), policy.begin(), policy.end());
      const CommandResult exact = convert(options);
      ASSERT_EQ(exact.exit_code, 0) << exact.err;
      EXPECT_EQ(run_weir({"compare", filled, output_}).out, "lossless: all 24000 finite voxels read bit for bit\n");
    }
    const CommandResult near = convert(
        {"--max-error", "0.01", "--missing-policy", "background", "--background", background, "--encoding", "packed"});
    ASSERT_EQ(near.exit_code, 0) << near.err;
    EXPECT_LE(Json::parse(run_weir({"compare", filled, output_, "--json"}).out)["max_abs"], 0.01) << bound;
    // Blocks whose mean lies outside the range of the other blocks' means do not lose quality.
    const CommandResult small =
        convert({"--rate", "8", "--missing-policy", "background", "--background", background, "--encoding", "packed"});
    ASSERT_EQ(small.exit_code, 0) << small.err;
    EXPECT_GT(sidecar()["error"]["psnr_db"], 38) << bound;
  }
}

TEST_P(MissingValues, ErrorTarget_IsOverValidVoxels) {
  const CommandResult result = convert({"--psnr", "60", "--missing-policy", "background"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json error = sidecar()["error"];
  const CommandResult compared = run_weir({"compare", input_, output_, "--json"});
  const Json found = Json::parse(compared.out);
  EXPECT_EQ(found["finite"], 18000);
  EXPECT_GE(found["psnr_db"].get<double>(), 60);
  EXPECT_NEAR(found["psnr_db"].get<double>(), error["psnr_db"].get<double>(), 1e-6);
  EXPECT_EQ(found["max_abs"], error["max_abs"]);
}

TEST_P(MissingValues, Keep_StoresTheFillValueAsData) {
  const CommandResult result = convert({"--lossless", "--missing-policy", "keep"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find(", lossless, 6000 of 24000 voxels (25 %) hold no data and are kept as data, "),
            std::string::npos)
      << result.err;
  const Json record = sidecar();
  EXPECT_EQ(record["missing"]["count"], 6000);
  EXPECT_EQ(record["missing"]["policy"], "keep");
  const float stored = packed_ ? static_cast<float>(-32767 * 0.01 + 20) : 1e20F;
  EXPECT_EQ(record["value_range"][packed_ ? 0 : 1].get<float>(), stored);
  EXPECT_EQ(run_weir({"verify", output_}).exit_code, 0);
  const CommandResult compared = run_weir({"compare", input_, output_});
  EXPECT_EQ(compared.out, "lossless: all 24000 finite voxels read bit for bit\n");
  EXPECT_NE(compared.err.find(": read with --dataset /temp --missing-policy keep, as " + output_ + ".json records\n"),
            std::string::npos)
      << compared.err;
  EXPECT_EQ(run_weir({"compare", input_, output_, "--missing-policy", "keep"}).out, compared.out);
  EXPECT_EQ(Json::parse(run_weir({"compare", input_, output_, "--json"}).out)["missing"], 6000);
  EXPECT_EQ(run_weir({"compare", input_, output_, "--missing-policy", "background"}).out,
            "lossless over valid voxels: all 18000 valid voxels read bit for bit\n"
            "missing    6000 of 24000 voxels (25 %) hold no data, left out of the error\n")
      << "what is given counts";
}

TEST_P(MissingValues, NonfiniteAlone_DecidesForThemToo) {
  ASSERT_EQ(convert({"--lossless", "--nonfinite", "background"}).exit_code, 0);
  EXPECT_EQ(sidecar()["missing"]["policy"], "background");
  const CommandResult kept = convert({"--lossless", "--nonfinite", "keep"});
  ASSERT_EQ(kept.exit_code, 0) << kept.err;
  EXPECT_NE(kept.err.find(", lossless over valid voxels, 6000 of 24000 voxels (25 %) hold no data and read NaN, "),
            std::string::npos)
      << kept.err;
  EXPECT_EQ(sidecar()["missing"]["policy"], "nan");
  EXPECT_EQ(run_weir({"verify", output_}).exit_code, 0);
}

TEST_P(MissingValues, NaNThatTheBackgroundReplaces_IsCountedInEveryReport) {
  ASSERT_TRUE(run_python(kOcean + std::string(R"(
temperature[3, 4, 20:25] = np.nan
temperature[19, 29, 39] = np.inf
np.where(land, 1.0, temperature).astype("f4").tofile("nan_40x30x20_float32.raw")
)"),
                         directory_ / ""));
  const std::string input = directory_ / "nan_40x30x20_float32.raw";
  const std::string said = "6 of 24000 voxels (less than 0.1 %) are NaN or infinite and read as the background";
  const CommandResult exact =
      run_weir({"convert", input, "-o", output_, "--lossless", "--nonfinite", "background", "--overwrite"});
  ASSERT_EQ(exact.exit_code, 0) << exact.err;
  EXPECT_NE(exact.err.find(", lossless over valid voxels, " + said + ", "), std::string::npos) << exact.err;
  const std::string shown = run_weir({"inspect", output_}).out;
  EXPECT_NE(shown.find("\nnot finite  " + said + "\n"), std::string::npos) << shown;
  EXPECT_EQ(run_weir({"compare", input, output_}).out,
            "lossless over valid voxels: all 23994 finite voxels read bit for bit\n"
            "not finite 6 voxels of the source, left out of the error; 6 of them read differently\n");
  const CommandResult kept =
      run_weir({"convert", input, "-o", output_, "--lossless", "--nonfinite", "keep", "--overwrite"});
  EXPECT_NE(kept.err.find(", lossless, "), std::string::npos) << kept.err;
}

INSTANTIATE_TEST_SUITE_P(Files, MissingValues, ::testing::Values("ocean.nc", "packed.nc"),
                         [](const auto& file) { return file.param == "ocean.nc" ? "Float" : "PackedShort"; });

}  // namespace
}  // namespace weir::missing_values_test
