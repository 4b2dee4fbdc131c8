#include "format/base/exact_text.h"

#include <gtest/gtest.h>

#include <limits>

namespace weir {
namespace {

TEST(ExactText, ReadsBackAsTheSameDouble) {
  for (const double value : {0.1, -0.0, 1e300, 1.0 / 3}) EXPECT_EQ(std::stod(exact_text(value)), value);
  EXPECT_EQ(exact_text(0.1), "0.1");
}

TEST(HexText, HasTheFormThatIdentitiesAreMadeOf) {
  EXPECT_EQ(hex_text(3), "0x1.8p+1");
  EXPECT_EQ(hex_text(0.1), "0x1.999999999999ap-4");
  EXPECT_EQ(hex_text(-0.0), "-0x0p+0");
  EXPECT_EQ(hex_text(std::numeric_limits<double>::infinity()), "inf");
}

}  // namespace
}  // namespace weir
