// Tests what weir compare reports beside the error: what float32 lost, and which figures of a volume are not defined.
#include <gtest/gtest.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/run_command.h"

namespace weir::compare_report_test {
namespace {

class CompareReport : public testing::Test {
 protected:
  // Converts `raw` to a lossless file, `nvdb_`.
  void convert(const std::string& raw) const {
    const CommandResult made =
        run_weir({"convert", raw, "-o", nvdb_, "--lossless", "--nonfinite", "keep", "--overwrite"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  std::string sampled(const std::string& kind) const {
    const std::string raw = directory_ / (kind + "_9x9x9_float32.raw");
    EXPECT_EQ(run_weir({"sample", kind, "-o", raw}).exit_code, 0);
    return raw;
  }
  nlohmann::json sidecar() const { return nlohmann::json::parse(read_file(nvdb_ + ".json")); }
  std::string text(const std::string& raw) const {
    const CommandResult said = run_weir({"compare", raw, nvdb_, "--derived"});
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return said.out;
  }
  nlohmann::json report(const std::string& raw) const {
    return nlohmann::json::parse(run_weir({"compare", raw, nvdb_, "--derived", "--json"}).out);
  }

  TemporaryDirectory directory_;
  std::string nvdb_ = directory_ / "a.nvdb";
};

// The values 2^53 + 0 .. 4095: float32 keeps nothing of their difference.
TEST_F(CompareReport, WhatFloat32Rounds_IsInTheJson) {
  std::string bytes;
  for (std::int64_t i = 0; i < 4096; ++i) {
    const std::int64_t value = (std::int64_t{1} << 53) + i;
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  const std::string raw = directory_ / "a_16x16x16_int64.raw";
  write_file(raw, bytes);
  convert(raw);
  EXPECT_EQ(report(raw)["lossless"], true);
  EXPECT_EQ(report(raw)["conversion_loss"],
            nlohmann::json::parse(R"({"inexact": 4095, "overflow": 0, "max_abs_error": 4095.0})"));
  EXPECT_EQ(report(raw)["conversion_loss"], sidecar()["conversion_loss"]);
}

TEST_F(CompareReport, ValuesBeyondFloat32_AreWarnedOf) {
  std::string bytes;
  for (int i = 0; i < 512; ++i) {
    const double value = i == 7 ? 1e300 : i;
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  const std::string raw = directory_ / "a_8x8x8_float64.raw";
  write_file(raw, bytes);
  convert(raw);
  const CommandResult said = run_weir({"compare", raw, nvdb_});
  EXPECT_NE(said.err.find(raw + ": 1 values are finite but beyond float32, and count as infinite\n"), std::string::npos)
      << said.err;
  EXPECT_EQ(report(raw)["conversion_loss"]["overflow"], 1);
}

TEST_F(CompareReport, WithoutAFiniteValue_NothingIsDefined) {
  const std::string raw = sampled("nan");
  convert(raw);
  const std::string said = text(raw);
  EXPECT_NE(said.find("\n|error|    not defined: no value is finite\n"), std::string::npos) << said;
  EXPECT_NE(said.find("\ngradient   not defined: every voxel is at or beside one that is not finite\n"),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("\nssim       not defined: no value is finite\n"), std::string::npos) << said;
  EXPECT_EQ(report(raw)["derived"]["quantiles"]["0.999"], nullptr);
  EXPECT_EQ(sidecar()["value_range"].dump(), "[null,null]");
  EXPECT_EQ(run_weir({"verify", nvdb_}).exit_code, 0);
  EXPECT_NE(run_weir({"inspect", nvdb_}).out.find(", range none finite\n"), std::string::npos);
}

TEST_F(CompareReport, OfOneValue_OnlySimilarityIsNotDefined) {
  const std::string raw = sampled("constant");
  convert(raw);
  const std::string said = text(raw);
  EXPECT_NE(said.find("\n|error|    50 % of voxels at most 0\n"), std::string::npos) << said;
  EXPECT_NE(said.find("\nssim       not defined for one value\n"), std::string::npos) << said;
}

}  // namespace
}  // namespace weir::compare_report_test
