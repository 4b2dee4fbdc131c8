#include "tools/sweep/sweep_report.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace weir::sweep_report_test {
namespace {

// 10 x 10 x 10 voxels: 4000 dense bytes.
SweepReport sample_report() {
  SweepReport report;
  report.source = "a, \"b\"\xff.raw";
  report.extent = {10, 10, 10};
  report.threads = 2;
  report.memory = 1 << 20;
  report.total_s = 3.5;
  report.peak_rss_bytes = 77;
  report.rows.push_back(
      {"auto", 2.5, 1600, SweepResult{"fpn", 1600, {0.1, 0.3, 0.25, 12.75, 1.5, false}, 0.5, 12, {7, 0, 0.5}}, ""});
  report.rows.push_back(
      {"zfp", 8, 500, SweepResult{"zfp", 496, {0, 0, 0, std::nullopt, 0, true}, 0.25, std::nullopt}, ""});
  report.rows.push_back({"paper", 20, 200, std::nullopt, "no, not \"this\""});
  return report;
}

TEST(SweepReport, Csv) {
  EXPECT_EQ(csv_text(sample_report()),
            "method,encoding,rate,bytes_asked,bytes_got,bits_per_voxel,mse,nmse,psnr_db,max_abs,lossless,seconds,"
            "gb_per_s,leaves_kept,note\n"
            "auto,fpn,2.5,1600,1600,12.8,0.1,0.25,12.75,1.5,false,0.5,8e-06,12,\n"
            "zfp,zfp,8,500,496,3.968,0,0,,0,true,0.25,1.6e-05,,\n"
            "paper,,20,200,,,,,,,,,,,\"no, not \"\"this\"\"\"\n");
}

TEST(SweepReport, Json) {
  EXPECT_EQ(nlohmann::json::parse(json_text(sample_report())), nlohmann::json::parse(R"({
      "source": "a, \"b\"\ufffd.raw", "extent": [10, 10, 10], "dense_float32_bytes": 4000, "threads": 2,
      "memory_bytes": 1048576, "total_s": 3.5, "peak_rss_bytes": 77, "rows": [
      {"method": "auto", "rate": 2.5, "bytes_asked": 1600, "encoding": "fpn", "bytes_got": 1600,
       "bits_per_voxel": 12.8, "mse": 0.1, "nmse": 0.25, "psnr_db": 12.75, "max_abs": 1.5, "lossless": false,
       "seconds": 0.5, "gb_per_s": 8e-6, "leaves_kept": 12,
       "conversion_loss": {"inexact": 7, "overflow": 0, "max_abs_error": 0.5}, "note": ""},
      {"method": "zfp", "rate": 8.0, "bytes_asked": 500, "encoding": "zfp", "bytes_got": 496,
       "bits_per_voxel": 3.968, "mse": 0.0, "nmse": 0.0, "psnr_db": null, "max_abs": 0.0, "lossless": true,
       "seconds": 0.25, "gb_per_s": 1.6e-5, "leaves_kept": null,
       "conversion_loss": {"inexact": 0, "overflow": 0, "max_abs_error": 0.0}, "note": ""},
      {"method": "paper", "rate": 20.0, "bytes_asked": 200, "encoding": null, "bytes_got": null,
       "bits_per_voxel": null, "mse": null, "nmse": null, "psnr_db": null, "max_abs": null, "lossless": null,
       "seconds": null, "gb_per_s": null, "leaves_kept": null, "conversion_loss": null,
       "note": "no, not \"this\""}]})"));
}

TEST(SweepReport, Table) {
  EXPECT_EQ(table_text(sample_report()),
            "method  rate  bytes asked  bytes got  bits/voxel  stored as   PSNR dB  MSE  max error  seconds     GB/s  "
            "leaves\n"
            "auto     2.5         1600       1600        12.8        fpn     12.75  0.1        1.5      0.5    8e-06  "
            "    12\n"
            "zfp        8          500        496       3.968        zfp  lossless    0          0     0.25  1.6e-05  "
            "     -\n"
            "paper     20          200  no, not \"this\"\n");
}

TEST(SweepReport, NoteOfWhatFloat32Loses_WhereThatCounts) {
  SweepResult result = *sample_report().rows[0].result;
  EXPECT_EQ(loss_note(result), "7 values rounded to float32, by up to 0.5");
  result.loss.max_abs_error = 0.01 * result.error.max_abs;
  EXPECT_EQ(loss_note(result), "") << "far less than the error";
  result.loss.overflow = 1;
  EXPECT_EQ(loss_note(result), "7 values rounded to float32, by up to 0.015, 1 value beyond float32 infinite");
  result.loss = {};
  EXPECT_EQ(loss_note(result), "");
}

// A volume of one value that lost something.
TEST(SweepReport, InfiniteNmse) {
  SweepReport report = sample_report();
  report.rows[0].result->error.nmse = std::numeric_limits<double>::infinity();
  report.rows[0].result->error.psnr_db.reset();
  EXPECT_NE(csv_text(report).find("0.1,inf,,1.5,false"), std::string::npos);
  EXPECT_TRUE(nlohmann::json::parse(json_text(report))["rows"][0]["nmse"].is_null());
  EXPECT_NE(table_text(report).find("fpn         -  0.1"), std::string::npos);
}

}  // namespace
}  // namespace weir::sweep_report_test
