// Tests the time of a volume, from its time axis and from times beside the array.
#include "ingest/axes/volume_time.h"

#include <gtest/gtest.h>

#include <array>

namespace weir::volume_time_test {
namespace {

AxisPlace time_axis(std::int64_t extent) {
  AxisPlace axis;
  axis.extent = extent;
  axis.is_time = true;
  axis.units = "hours since 2000-01-01";
  axis.calendar = "noleap";
  return axis;
}

TEST(VolumeTime, CoordinateOfThePosition_IsTheTime) {
  AxisPlace member;
  member.extent = 4;
  AxisPlace time = time_axis(3);
  time.coordinates = {6, 9, 18};
  const std::array<const AxisPlace*, 2> leading{&member, &time};
  const std::array<std::int64_t, 2> index{1, 2};
  const TimePosition position = time_position(leading, index);
  EXPECT_EQ(position.at, 2U);
  EXPECT_EQ(position.extent, 3U);
  ASSERT_TRUE(position.coordinate);
  EXPECT_EQ(position.coordinate->value, 18);
  EXPECT_EQ(position.coordinate->units, "hours since 2000-01-01");
  EXPECT_EQ(position.coordinate->calendar, "noleap");
}

TEST(VolumeTime, SpacingOfTheAxis_GivesTheTime) {
  AxisPlace time = time_axis(3);
  time.spacing = 0.5;
  time.origin = 10.0;
  const std::array<const AxisPlace*, 1> leading{&time};
  const std::array<std::int64_t, 1> index{2};
  EXPECT_EQ(time_position(leading, index).coordinate->value, 11);
}

TEST(VolumeTime, TimesBesideTheArray_AreOneOrAsManyAsTheAxisHasElements) {
  const AxisPlace time = time_axis(3);
  const std::array<const AxisPlace*, 1> leading{&time};
  const std::array<std::int64_t, 1> index{1};
  const TimePosition position = time_position(leading, index);
  EXPECT_FALSE(position.coordinate);
  EXPECT_EQ(position.in({{7, 8, 9}, "s", {}})->value, 8);
  EXPECT_EQ(position.in({{7}, "s", {}})->value, 7);
  EXPECT_FALSE(position.in({{7, 8}, "s", {}}));
  EXPECT_FALSE(position.in({}));
}

TEST(VolumeTime, TimesOfALongerDimension_AreThoseOfItsFirstElements) {
  AxisPlace time = time_axis(3);
  time.unwritten = 2;
  const std::array<const AxisPlace*, 1> leading{&time};
  const std::array<std::int64_t, 1> index{2};
  const TimePosition position = time_position(leading, index);
  EXPECT_EQ(position.in({{7, 8, 9, 10, 11}, "s", {}})->value, 9);
  EXPECT_EQ(position.in({{7, 8, 9}, "s", {}})->value, 9);
  EXPECT_FALSE(position.in({{7, 8, 9, 10}, "s", {}}));
}

TEST(VolumeTime, WithoutAnAxisOfTime_OneTimeIsForAll) {
  const TimePosition nowhere = time_position({}, {});
  EXPECT_EQ(nowhere.in({{7}, {}, {}})->value, 7);
  EXPECT_FALSE(nowhere.in({{7, 8}, {}, {}}));
  EXPECT_FALSE(nowhere.in({}));
}

}  // namespace
}  // namespace weir::volume_time_test
