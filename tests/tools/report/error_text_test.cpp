#include "tools/report/error_text.h"

#include <gtest/gtest.h>

namespace weir::error_text_test {
namespace {

Sidecar sidecar(double low, double high, const std::string& units) {
  Sidecar s;
  s.value_range = {low, high};
  s.source.units = units;
  s.source.extent = {8, 8, 8};
  return s;
}

TEST(ErrorText, SaysPsnrAndLargestError_WithUnitsAndShareOfTheRange) {
  Sidecar::CertifiedError error;
  error.psnr_db = 54.298058874045665;
  error.max_abs = 0.3428571445;
  EXPECT_EQ(error_text(sidecar(200, 300, "K"), error), "PSNR 54.3 dB, largest error 0.3429 K (0.3429 % of the range)");
  EXPECT_EQ(error_text(sidecar(-1, 1, ""), error), "PSNR 54.3 dB, largest error 0.3429 (17.14 % of the range)");
  EXPECT_EQ(error_text(sidecar(0, 1, "K\n"), error), "PSNR 54.3 dB, largest error 0.3429 K? (34.29 % of the range)");
}

TEST(ErrorText, WithoutARange_SaysTheErrorAlone) {
  Sidecar::CertifiedError error;
  error.max_abs = 2;
  EXPECT_EQ(error_text(sidecar(5, 5, "K"), error), "PSNR none, largest error 2 K");
}

TEST(ErrorText, GradientOfNoVoxel_IsNotDefined) {
  EXPECT_EQ(gradient_text({0, std::nullopt, 0, 0, 512}, "K"),
            "not defined: every voxel is at or beside one that is not finite");
  EXPECT_EQ(gradient_text({0, std::nullopt, 0, 511, 1}, "K"),
            "largest error 0 K per world unit; 1 voxel at or beside one that is not finite left out");
}

TEST(ErrorText, Lossless) {
  Sidecar::CertifiedError error;
  error.lossless = true;
  Sidecar s = sidecar(0, 1, "K");
  s.error = error;
  EXPECT_EQ(error_text(s, error), "lossless");
}

}  // namespace
}  // namespace weir::error_text_test
