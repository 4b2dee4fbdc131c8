#include <cmath>

#include "tools/report/forecast_report.h"

#include <gtest/gtest.h>

namespace weir::forecast_report_test {
namespace {

// Returns a forecast from a sixteenth of 1024^3 voxels, in eight parts.
Forecast sampled() {
  Forecast f;
  f.sampled_voxels = std::uint64_t{1} << 26U;
  f.places = 1024;
  f.parts = 8;
  f.volume_bytes = std::uint64_t{1} << 31U;
  f.passes = 1.75;
  f.read_bytes = std::uint64_t{7} << 29U;
  f.encoding = "packed";
  f.exact_bytes = true;
  f.file_bytes = {536870912, 536870912, 536870912};
  f.scratch_bytes = 300 << 20U;
  f.memory_bytes = 100 << 20U;
  f.threads = 2;
  f.error.psnr_db = Expected{61.24, 60.81, 62.4};
  f.error.rmse = 0.0123;
  f.value_high = 4000;
  f.survey_s = 12.2;
  f.encode_s = 7.26;
  return f;
}

SourceInfo source() {
  SourceInfo info;
  info.path = "v.raw";
  info.extent = {1024, 1024, 1024};
  info.type = ScalarType::uint16;
  return info;
}

ConversionOptions to_rate() {
  ConversionOptions options;
  options.output = "v.nvdb";
  options.budget.kind = Budget::Kind::rate;
  return options;
}

TEST(ForecastReport, OfASample_SaysHowFarItIsUncertain) {
  EXPECT_EQ(
      forecast_text(sampled(), source(), to_rate()),
      "v.raw: 1024x1024x1024 voxels of uint16, 2.0 GiB\n"
      "  sample    6.3 % of the voxels, from 1024 places of the volume\n"
      "  reads     3.5 GiB in 1.8 passes\n"
      "  writes    v.nvdb: 536870912 bytes, and 300.0 MiB until it is done\n"
      "  memory    up to 100.0 MiB of 512.0 MiB, 2 threads\n"
      "  encoding  packed\n"
      "  error     PSNR about 61.2 dB (60.8 to 62.4), RMSE 0.0123, values from 0 to 4000, range and background of "
      "the sample\n"
      "  time      about 19 s: survey 12 s, encoding 7.3 s\n");
  const auto json = forecast_json(sampled(), source(), to_rate());
  EXPECT_EQ(json["sample"].dump(), R"({"voxels":67108864,"share":0.0625,"places":1024,"parts":8,"none":null})");
  EXPECT_EQ(json["file"].dump(), R"({"value":536870912.0,"low":null,"high":null,"exact":true})");
  EXPECT_EQ(json["error"]["psnr_db"].dump(), R"({"value":61.24,"low":60.81,"high":62.4})");
  EXPECT_EQ(json["error"]["max_abs"], nullptr);
  EXPECT_EQ(json["read"]["passes"], 1.75);
}

TEST(ForecastReport, ForAnErrorTarget_TheSizeIsUncertain) {
  ConversionOptions options = to_rate();
  options.budget.kind = Budget::Kind::psnr;
  Forecast f = sampled();
  f.exact_bytes = false;
  f.file_bytes = {1000.4, 900, 1100};
  const std::string text = forecast_text(f, source(), options);
  EXPECT_NE(text.find("  writes    v.nvdb: about 1000 bytes (900 to 1100), and"), std::string::npos) << text;
  EXPECT_NE(text.find("PSNR about 61.2 dB, RMSE"), std::string::npos) << text;
  const auto json = forecast_json(f, source(), options);
  EXPECT_EQ(json["file"].dump(), R"({"value":1000.4,"low":900.0,"high":1100.0,"exact":false})");
  EXPECT_EQ(json["error"]["psnr_db"]["low"], nullptr);
}

TEST(ForecastReport, Lossless_IsSaidOfTheSampleAlone) {
  Forecast f = sampled();
  f.error.lossless = true;
  f.error.psnr_db.reset();
  EXPECT_NE(forecast_text(f, source(), to_rate()).find("  error     lossless in the sample, values from 0 to 4000\n"),
            std::string::npos);
  EXPECT_EQ(forecast_json(f, source(), to_rate())["error"]["psnr_db"], nullptr);
}

TEST(ForecastReport, WhatFloat32Rounds_IsSaid) {
  Forecast f = sampled();
  EXPECT_EQ(forecast_text(f, source(), to_rate()).find("rounded"), std::string::npos);
  EXPECT_EQ(forecast_json(f, source(), to_rate())["conversion_loss"].dump(),
            R"({"inexact":0,"overflow":0,"max_abs_error":0.0})");
  f.loss = {1000, 0, 1};
  EXPECT_NE(forecast_text(f, source(), to_rate())
                .find("  rounded   1000 values rounded to float32, by up to 1, in the sample; the error does not count "
                      "that\n"),
            std::string::npos)
      << forecast_text(f, source(), to_rate());
  f.whole = true;
  EXPECT_NE(forecast_text(f, source(), to_rate())
                .find("  rounded   1000 values rounded to float32, by up to 1; the error does not count that\n"),
            std::string::npos);
  EXPECT_EQ(forecast_json(f, source(), to_rate())["conversion_loss"].dump(),
            R"({"inexact":1000,"overflow":0,"max_abs_error":1.0})");
  f.not_sampled = "no";
  EXPECT_EQ(forecast_json(f, source(), to_rate())["conversion_loss"], nullptr);
}

TEST(ForecastReport, WithoutAFiniteValue_HasNoRange) {
  Forecast f = sampled();
  f.value_low = f.value_high = std::nan("");
  EXPECT_NE(forecast_text(f, source(), to_rate()).find("  error     none: no value of the sample is finite\n"),
            std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(forecast_json(f, source(), to_rate())["error"]["value_range"].dump()),
            (nlohmann::json{nullptr, nullptr}));
}

TEST(ForecastReport, NamesThatSteerATerminal_AreOneLine) {
  SourceInfo info = source();
  info.path = "a\nb\x1b[31m.raw";
  ConversionOptions options = to_rate();
  options.output = "o\nut.nvdb";
  const std::string text = forecast_text(sampled(), info, options);
  EXPECT_EQ(text.find("a\\nb\\x1b[31m.raw: 1024x1024x1024 voxels"), 0U) << text;
  EXPECT_NE(text.find("\n  writes    o\\nut.nvdb: "), std::string::npos) << text;
}

TEST(ForecastReport, WithAScene_TellsTheErrorOfWhatItShows) {
  ConversionOptions options = to_rate();
  options.scene.emplace();
  Forecast f = sampled();
  f.shown = ForecastError{false, Expected{71.5, 70.25, 72}, 0.001, 0};
  f.shown_voxels = f.sampled_voxels / 8;
  const std::string text = forecast_text(f, source(), options);
  EXPECT_NE(text.find("  error     PSNR about 61.2 dB (60.8 to 62.4), RMSE 0.0123, values from 0 to 4000, range and "
                      "background of the sample\n"
                      "  shown     PSNR about 71.5 dB (70.2 to 72.0), RMSE 0.001, over 12.5 % of the voxels\n"),
            std::string::npos)
      << text;
  EXPECT_EQ(forecast_json(f, source(), options)["visible"].dump(),
            R"({"share":0.125,"lossless":false,"psnr_db":{"value":71.5,"low":70.25,"high":72.0},"rmse":0.001,)"
            R"("max_abs":null})");
  // A requested PSNR is that of what the scene shows.
  options.budget.kind = Budget::Kind::psnr;
  EXPECT_NE(forecast_text(f, source(), options).find("  shown     PSNR about 71.5 dB, RMSE 0.001"), std::string::npos);
  EXPECT_EQ(forecast_json(f, source(), options)["visible"]["psnr_db"]["low"], nullptr);
  EXPECT_EQ(forecast_json(f, source(), options)["error"]["psnr_db"]["low"], 60.81);
  f.shown.reset();
  EXPECT_NE(forecast_text(f, source(), options).find("  shown     nothing of the sample\n"), std::string::npos);
  EXPECT_EQ(forecast_json(f, source(), options)["visible"], nullptr);
}

TEST(ForecastReport, WithoutASample_TellsNoError) {
  Forecast f = sampled();
  f.not_sampled = "its chunks are too large for a sample";
  f.scratch_bytes = 0;
  EXPECT_EQ(forecast_text(f, source(), to_rate()),
            "v.raw: 1024x1024x1024 voxels of uint16, 2.0 GiB\n"
            "  sample    none: its chunks are too large for a sample\n"
            "  writes    v.nvdb: 536870912 bytes\n"
            "  memory    up to 100.0 MiB of 512.0 MiB, 2 threads\n");
  const auto json = forecast_json(f, source(), to_rate());
  EXPECT_EQ(json["sample"]["none"], "its chunks are too large for a sample");
  EXPECT_EQ(json["time"], nullptr);
  EXPECT_EQ(json["file"]["value"], 536870912.0);
}

}  // namespace
}  // namespace weir::forecast_report_test
