// Tests the note about elements of a dimension that were not written.
#include "ingest/axes/axis_place.h"

#include <gtest/gtest.h>

namespace weir::axis_place_test {
namespace {

TEST(AxisPlace, UnwrittenNote_NamesTheDimension) {
  std::vector<AxisPlace> axes(1);
  axes[0].extent = 2;
  axes[0].unwritten = 1;
  const std::string rest = " has 3 elements, of which 2 are written here: positions count these, and the last one is 1";
  EXPECT_EQ(unwritten_note(axes), "its axis 0" + rest);
  axes[0].label = "time";
  EXPECT_EQ(unwritten_note(axes), "its dimension time" + rest);
}

}  // namespace
}  // namespace weir::axis_place_test
