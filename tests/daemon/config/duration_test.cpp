#include "daemon/config/duration.h"

#include <gtest/gtest.h>

namespace weir::duration_test {
namespace {

TEST(Duration, NumbersWithUnits_AreSeconds) {
  EXPECT_EQ(parse_duration_s("90"), 90);
  EXPECT_EQ(parse_duration_s("90s"), 90);
  EXPECT_EQ(parse_duration_s("10min"), 600);
  EXPECT_EQ(parse_duration_s("1.5 h"), 5400);
  EXPECT_EQ(parse_duration_s("3d"), 259200);
  EXPECT_EQ(parse_duration_s("0"), 0);
}

TEST(Duration, OtherTexts_AreNone) {
  for (const char* text : {"", "min", "10m", "10 minutes", "-1s", "1h30min", "nan", "inf", "s10"}) {
    EXPECT_EQ(parse_duration_s(text), std::nullopt) << text;
  }
}

}  // namespace
}  // namespace weir::duration_test
