// Tests which names, units and CF attributes make an axis a time axis.
#include "ingest/axes/time_axis.h"

#include <gtest/gtest.h>

namespace weir::time_axis_test {
namespace {

TEST(TimeAxis, ConventionsOfCfSayIt) {
  EXPECT_TRUE(is_time_axis({"a", {}, "T", {}, false}));
  EXPECT_TRUE(is_time_axis({"a", {}, {}, "time", false}));
  EXPECT_TRUE(is_time_axis({"step", "hours", {}, "forecast_period", false}));
  EXPECT_TRUE(is_time_axis({"run", "hours", {}, "forecast_reference_time", false}));
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

// An axis called time is a time axis even if weir does not know its unit.
TEST(TimeAxis, NameTimeSaysItInAnyUnitButOneOfSpace) {
  for (const char* name : {"time", "Time", "times", "TIMES"}) {
    for (const char* units :
         {"", "1", "s", "seconds", "milliseconds", "microseconds", "nanoseconds", "femtoseconds", "weeks", "kyr", "Myr",
          "Gyr", "a", "M", "steps", "code_time", "code units", "1/omega_pe", "day as %Y%m%d.%f"}) {
      for (const bool grows : {false, true}) {
        EXPECT_TRUE(is_time_axis({name, units, {}, {}, grows})) << name << " in " << units;
      }
      EXPECT_FALSE(is_time_axis({name, units, "Z", {}, false})) << name << " in " << units;
    }
    for (const char* units : {"m", "meters", "km", "kpc", "Mpc", "degrees", "degrees_north", "rad", "hPa", "level"}) {
      for (const bool grows : {false, true}) {
        EXPECT_FALSE(is_time_axis({name, units, {}, {}, grows})) << name << " in " << units;
      }
    }
  }
}

TEST(TimeAxis, OtherNamesAreATimeInUnitsOfTimeAlone) {
  for (const char* name : {"t", "T", "timestep", "time_counter"}) {
    for (const char* units : {"s", "milliseconds", "microseconds", "nanoseconds", "attoseconds", "weeks", "yr", "kyr",
                              "Myr", "Gyr", "code_time"}) {
      EXPECT_TRUE(is_time_axis({name, units, {}, {}, false})) << name << " in " << units;
    }
    for (const char* units : {"", "1", "m", "K", "code units"}) {
      EXPECT_FALSE(is_time_axis({name, units, {}, {}, false})) << name << " in " << units;
    }
  }
  for (const char* name : {"z", "depth", "cycle", "a"}) {
    EXPECT_FALSE(is_time_axis({name, "milliseconds", {}, {}, false})) << name;
    EXPECT_FALSE(is_time_axis({name, "1", {}, {}, false})) << name;
  }
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

TEST(TimeAxis, DimensionThatGrowsIsATimeInUnitsThatSayNothing) {
  for (const char* units : {"", "1", "steps", "code units", "Myr"}) {
    EXPECT_TRUE(is_time_axis({"cycle", units, {}, {}, true})) << units;
    EXPECT_FALSE(is_time_axis({"cycle", units, {}, {}, false})) << units;
  }
  for (const char* units : {"", "1", "steps"}) {
    for (const char* name : {"z", "x", "lat", "level", "height", "k", "eta_rho"}) {
      EXPECT_FALSE(is_time_axis({name, units, {}, {}, true})) << name << " in " << units;
    }
    for (const char* axis : {"X", "Y", "Z"}) EXPECT_FALSE(is_time_axis({"cycle", units, axis, {}, true})) << axis;
    EXPECT_FALSE(is_time_axis({"cycle", units, {}, "realization", true})) << units;
  }
  for (const char* units : {"m", "degrees_north", "hPa", "sigma_level"}) {
    EXPECT_FALSE(is_time_axis({"cycle", units, {}, {}, true})) << units;
  }
}

// A dimension that grows is no time axis if its unit measures something else. Units that say nothing do not count.
TEST(TimeAxis, DimensionThatGrowsInAnotherUnitIsNone) {
  for (const char* units : {"GeV", "Hz", "cm-1", "km/s", "kelvin", "kg m-3", "percent", "R_sun", "c/omega_pe", "a"}) {
    EXPECT_FALSE(is_time_axis({"slice", units, {}, {}, true})) << units;
  }
  for (const char* positive : {"up", "down"}) EXPECT_FALSE(is_time_axis({"slice", {}, {}, {}, true, positive}));
  EXPECT_FALSE(is_time_axis({"depth", "ms", {}, {}, true})) << "of a seismic volume";
}

}  // namespace
}  // namespace weir::time_axis_test
