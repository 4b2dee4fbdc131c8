// Tests which units are of time, which are of an axis of space, and which are neither.
#include "ingest/axes/axis_unit.h"

#include <gtest/gtest.h>

#include <string>

#include "format/base/text.h"

namespace weir::axis_unit_test {
namespace {

TEST(AxisUnit, OfATime_IsNoneOfSpace) {
  for (const std::string& unit :
       split("s S sec second seconds ms millisecond milliseconds us \u00b5s \u03bcs microseconds ns nanosecond "
             "nanoseconds ps picoseconds fs femtoseconds as attoseconds kiloseconds min mins minute Minutes h "
             "hr hours d day Days week weeks month months year years yr kyr Myr Gyr Ma megayears code_time",
             ' ')) {
    EXPECT_TRUE(is_unit_of_time(unit)) << unit;
    EXPECT_FALSE(is_unit_of_space(unit)) << unit;
  }
}

TEST(AxisUnit, OfALengthAngleOrPressure_IsNoneOfTime) {
  for (const std::string& unit :
       split("m meter meters metre Metres km kilometers cm mm um \u00b5m \u03bcm micrometer microns nm "
             "nanometres Mm A \u00c5 angstrom pc kpc Mpc megaparsec AU ft feet inch code_length pixels deg "
             "degree degrees degrees_north degree_east degreesN \u00b0 rad radians mrad arcsec Pa hPa pascals "
             "mbar millibars bar dbar decibar sigma sigma_level level levels layer K",
             ' ')) {
    EXPECT_TRUE(is_unit_of_space(unit)) << unit;
    EXPECT_FALSE(is_unit_of_time(unit)) << unit;
  }
}

TEST(AxisUnit, OfSeveralWordsOrBetweenBlanks_IsFound) {
  EXPECT_TRUE(is_unit_of_time(" Seconds "));
  EXPECT_TRUE(is_unit_of_space("model level"));
  EXPECT_TRUE(is_unit_of_space(" m"));
}

TEST(AxisUnit, ThatSaysNeither_IsNone) {
  for (const char* unit : {"", "1", "M", "a", "steps", "code units", "hours since 2000-01-01", "day as %Y%m%d", "kg/kg",
                           "m/s", "perimeter", "k", "meterss", "millis"}) {
    EXPECT_FALSE(is_unit_of_time(unit)) << unit;
    EXPECT_FALSE(is_unit_of_space(unit)) << unit;
  }
}

}  // namespace
}  // namespace weir::axis_unit_test
