#include "compressor/default_notice.h"

#include <gtest/gtest.h>

#include <string>

namespace weir::default_notice_test {
namespace {

std::string notice(const std::string& kind, double rate, double psnr_db, double nmse) {
  Sidecar sidecar;
  sidecar.budget.kind = kind;
  sidecar.budget.rate = rate;
  sidecar.budget.file_bytes = 309664;
  sidecar.error.psnr_db = psnr_db;
  sidecar.error.nmse = nmse;
  return default_notice(sidecar, "a.nvdb").text();
}

TEST(DefaultNotice, NumbersHaveFourSignificantDigits_HoweverSmall) {
  EXPECT_EQ(notice("minimum", 0.0024131, 21.4567, 7.1499e-3),
            "a.nvdb: no budget was given, and rate 0.002413 keeps 21.46 dB, an error (RMSE) of 8.456 % of the value "
            "range; give a smaller --rate, or --psnr 60 for instance");
  EXPECT_EQ(notice("psnr", 0.0487654, 40.1234, 1e-4),
            "a.nvdb: no budget was given, and --rate 8 would keep less than 40 dB of so small a volume; written with "
            "40.12 dB: 309664 bytes, rate 0.04877; give a budget for another size");
}

TEST(DefaultNotice, EnoughKept_IsNotMentioned) { EXPECT_EQ(notice("rate", 8, 40, 1e-4), ""); }

}  // namespace
}  // namespace weir::default_notice_test
