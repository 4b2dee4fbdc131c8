// Tests small volumes that are converted without a budget: their values survive, and a message says how.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/run_command.h"

namespace weir::small_volume_test {
namespace {

using Json = nlohmann::json;

class SmallVolume : public ::testing::Test {
 protected:
  std::string sample(const std::string& kind, const std::string& shape) {
    std::string raw = directory_ / (kind + "_" + shape + ".raw");
    const CommandResult result = run_weir({"sample", kind, "-o", raw});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return raw;
  }
  Json convert(const std::string& raw, const std::vector<std::string>& options) {
    std::vector<std::string> all{"convert", raw, "-o", output_, "--overwrite", "--json"};
    all.insert(all.end(), options.begin(), options.end());
    const CommandResult result = run_weir(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    err_ = result.err;
    return Json::parse(result.out);
  }

  const TemporaryDirectory directory_;
  const std::string output_ = directory_ / "a.nvdb";
  std::string err_;
};

TEST_F(SmallVolume, NoiseThatRate8Destroys_Keeps40Decibels) {
  const std::string raw = sample("noise", "80x80x80_float32");
  const Json record = convert(raw, {});
  EXPECT_EQ(record["budget"]["kind"], "psnr");
  EXPECT_EQ(record["budget"]["requested"], 40);
  EXPECT_GE(record["error"]["psnr_db"].get<double>(), 40);
  EXPECT_NE(err_.find(output_ + ": no budget was given, and --rate 8 would keep less than 40 dB of so small a volume; "
                                "written with 4"),
            std::string::npos)
      << err_;
  EXPECT_NE(err_.find(" (default: 40 dB), "), std::string::npos) << err_;
  EXPECT_EQ(run_weir({"verify", output_}).exit_code, 0);
}

TEST_F(SmallVolume, NoiseOfBytes_IsLosslessInLessThanItsFloats) {
  const Json record = convert(sample("noise", "96x96x96_uint8"), {});
  EXPECT_EQ(record["budget"]["kind"], "lossless");
  EXPECT_TRUE(record["error"]["lossless"].get<bool>());
  EXPECT_LT(record["budget"]["file_bytes"], record["budget"]["dense_float32_bytes"]);
  EXPECT_NE(err_.find("less than 40 dB of so small a volume; written lossless: "), std::string::npos) << err_;
}

TEST_F(SmallVolume, PackedAtRate8_IsLeftAsItIsWhereItKeepsEnough) {
  const Json record = convert(sample("turbulence", "80x80x80_float32"), {"--encoding", "packed"});
  EXPECT_EQ(record["budget"]["kind"], "rate");
  EXPECT_GE(record["error"]["psnr_db"].get<double>(), 40);
  EXPECT_EQ(err_.find("no budget was given"), std::string::npos) << err_;
}

TEST_F(SmallVolume, RateThatWasAskedFor_IsWhatItGets) {
  const Json record = convert(sample("noise", "80x80x80_float32"), {"--rate", "4"});
  EXPECT_EQ(record["budget"]["kind"], "rate");
  EXPECT_EQ(record["budget"]["file_bytes"], 512000);
}

TEST_F(SmallVolume, OneVoxel_IsKept) {
  const Json record = convert(sample("noise", "1x1x1_float32"), {});
  EXPECT_TRUE(record["error"]["lossless"].get<bool>());
}

TEST_F(SmallVolume, LargerVolumeThatRate8Destroys_IsSaidByItsError) {
  const Json record = convert(sample("noise", "128x128x128_float32"), {});
  EXPECT_EQ(record["budget"]["kind"], "rate");
  ASSERT_LT(record["error"]["psnr_db"].get<double>(), 40);
  EXPECT_NE(err_.find(" % of the value range; give a smaller --rate, or --psnr 60 for instance"), std::string::npos)
      << err_;
}

}  // namespace
}  // namespace weir::small_volume_test
