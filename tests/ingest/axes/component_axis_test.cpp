// Tests how the axis of components is found by names and extents, with and without --component.
#include "ingest/axes/component_axis.h"

#include <gtest/gtest.h>

#include <vector>

namespace weir::component_axis_test {
namespace {

std::vector<AxisPlace> axes(const std::vector<std::int64_t>& extents, const std::string& last = {}) {
  std::vector<AxisPlace> all;
  for (const std::int64_t extent : extents) all.push_back({extent, {}, {}, {}, {}});
  all.back().label = last;
  return all;
}

TEST(ComponentAxis, NameOfTheLastAxisIsSure) {
  for (const char* name : {"component", "vector_components", "RGB", "xyz", "channel", "stress_tensor"}) {
    const ComponentAxis found = component_axis(axes({2, 2, 2, 6}, name));
    EXPECT_EQ(found.count, 6);
    EXPECT_EQ(found.evidence, std::string("by its name ") + name);
  }
  EXPECT_FALSE(component_axis(axes({20, 20, 20, 3}, "west_east")).found());
  EXPECT_FALSE(component_axis(axes({20, 20, 3}, "component")).found());
}

TEST(ComponentAxis, ExtentAloneCountsUnlessTheAxisBeforeIsShorter) {
  for (const std::int64_t count : {2, 3, 4, 9}) {
    for (const char* name : {"", "nv", "three", "d"}) {
      EXPECT_EQ(component_axis(axes({10, 11, 12, count}, name)).count, count);
      EXPECT_EQ(component_axis(axes({10, 11, 12, count}, name)).evidence, "by its extent alone");
    }
  }
  EXPECT_TRUE(component_axis(axes({2, 10, 11, 12, 3})).found());
  EXPECT_TRUE(component_axis(axes({2, 11, 12, 3})).found()) << "a thin volume";
  EXPECT_FALSE(component_axis(axes({10, 11, 12, 5})).found());
  EXPECT_FALSE(component_axis(axes({2, 5, 7, 9})).found());
  EXPECT_FALSE(component_axis(axes({10, 11, 12, 3}, "x")).found());
  EXPECT_FALSE(component_axis(axes({10, 11, 12, 3}, "longitude")).found());
}

TEST(ComponentAxis, AxisBeforeThatIsLikeXMakesTheExtentSurer) {
  std::vector<AxisPlace> named = axes({10, 2, 2, 3}, "nv");
  for (const char* name : {"x", "lon", "west_east", "Longitude"}) {
    named[2].label = name;
    EXPECT_EQ(component_axis(named).count, 3) << name;
    EXPECT_EQ(component_axis(named).evidence, std::string("by its extent, after the axis ") + name);
  }
  named[2].label = "j2";
  EXPECT_FALSE(component_axis(named).found());
  named[2].has_coordinates = true;
  EXPECT_EQ(component_axis(named).evidence, "by its extent, after the axis j2");
  named[3].has_coordinates = true;
  EXPECT_FALSE(component_axis(named).found()) << "both have coordinates, and the axis before is shorter";
  named[2].extent = 20;
  EXPECT_EQ(component_axis(named).evidence, "by its extent alone");
  named[3].units = "m";
  EXPECT_FALSE(component_axis(named).found()) << "coordinates in metres are of space";
}

TEST(ComponentAxis, LastAxisOfTimeIsNone) {
  std::vector<AxisPlace> last = axes({10, 11, 12, 3}, "time");
  last[3].is_time = true;
  EXPECT_FALSE(component_axis(last).found());
  EXPECT_FALSE(asked_component_axis(last).found());
}

TEST(ComponentAxis, SeriesOfNarrowPlanesHasNone) {
  std::vector<AxisPlace> series = axes({10, 11, 12, 3});
  series[1].is_time = true;
  EXPECT_FALSE(component_axis(series).found());
}

TEST(ComponentAxis, WhoAsksForOneGetsTheUnnamedAxisThatIsShort) {
  EXPECT_EQ(asked_component_axis(axes({7, 8, 9, 6})).count, 6);
  EXPECT_FALSE(asked_component_axis(axes({7, 8, 9, 6})).leading);
  EXPECT_EQ(asked_component_axis(axes({3, 40, 48, 56})).count, 3);
  EXPECT_TRUE(asked_component_axis(axes({3, 40, 48, 56})).leading);
  EXPECT_FALSE(asked_component_axis(axes({3, 4, 5})).found());
  EXPECT_FALSE(asked_component_axis(axes({7, 8, 9, 6}, "lon")).found());
  EXPECT_FALSE(asked_component_axis(axes({65, 70, 80, 90})).found());
  EXPECT_EQ(asked_component_axis(axes({5, 6, 2, 3})).count, 3) << "whatever is before it";
  EXPECT_EQ(asked_component_axis(axes({5, 6, 7, 3}, "lon")).count, 3) << "whatever it is called";
  EXPECT_EQ(asked_component_axis(axes({5, 6, 7, 3}, "lon")).evidence, "as asked for");
  EXPECT_TRUE(asked_component_axis(axes({3, 60, 70, 4}, "lon")).leading) << "one of which nothing is said comes first";
  std::vector<AxisPlace> series = axes({3, 40, 48, 56});
  series[0].is_time = true;
  EXPECT_FALSE(asked_component_axis(series).found());
}

TEST(ComponentAxis, LeadingOneIsFoundByItsNameWhereItIsAskedFor) {
  std::vector<AxisPlace> named = axes({6, 4, 5, 7});
  named[0].label = "component";
  EXPECT_FALSE(component_axis(named).found());
  EXPECT_EQ(asked_component_axis(named).evidence, "by its name component");
  EXPECT_TRUE(asked_component_axis(named).leading);
}

}  // namespace
}  // namespace weir::component_axis_test
