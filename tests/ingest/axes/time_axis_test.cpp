#include "ingest/axes/time_axis.h"

#include <gtest/gtest.h>

namespace weir::time_axis_test {
namespace {

TEST(TimeAxis, ConventionsOfCfSayIt) {
  EXPECT_TRUE(is_time_axis({"a", {}, "T", {}, false}));
  EXPECT_TRUE(is_time_axis({"a", {}, {}, "time", false}));
  EXPECT_TRUE(is_time_axis({"a", "hours since 1990-01-01 00:00:00", {}, {}, false}));
  EXPECT_FALSE(is_time_axis({"time", "hours since 1990-01-01", "Z", {}, false}));
}

TEST(TimeAxis, NameTimeSaysItUnlessTheUnitsAreOfSomethingElse) {
  EXPECT_TRUE(is_time_axis({"Time", {}, {}, {}, false}));
  EXPECT_TRUE(is_time_axis({"time", "seconds", {}, {}, false}));
  EXPECT_TRUE(is_time_axis({"t", "days", {}, {}, false}));
  EXPECT_FALSE(is_time_axis({"t", {}, {}, {}, false}));
  EXPECT_FALSE(is_time_axis({"time", "m", {}, {}, false}));
}

TEST(TimeAxis, TravelTimeOfASeismicVolumeIsADepth) {
  EXPECT_FALSE(is_time_axis({"twt", "ms", {}, {}, false}));
  EXPECT_FALSE(is_time_axis({"two_way_time", "ms", {}, {}, false}));
}

TEST(TimeAxis, DimensionThatGrowsIsATimeUnlessItIsALength) {
  EXPECT_TRUE(is_time_axis({"record", {}, {}, {}, true}));
  EXPECT_TRUE(is_time_axis({"record", "s", {}, {}, true}));
  EXPECT_FALSE(is_time_axis({"depth", "m", {}, {}, true}));
  EXPECT_FALSE(is_time_axis({"level", {}, "Z", {}, true}));
  EXPECT_FALSE(is_time_axis({"level", {}, {}, "model_level_number", true}));
}

}  // namespace
}  // namespace weir::time_axis_test
