#include "format/leaf/leaf_record.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace weir {
namespace {

TEST(KeptOf, TwoConditions_AreTheLeastThatHolds) {
  EXPECT_EQ(kept_of(true, true), Kept::all);
  EXPECT_EQ(kept_of(false, true), Kept::all);  // of voxels none of which was replaced
  EXPECT_EQ(kept_of(true, false), Kept::values);
  EXPECT_EQ(kept_of(false, false), Kept::lossy);
  EXPECT_EQ(std::min(kept_of(true, false), kept_of(true, true)), Kept::values);
}

}  // namespace
}  // namespace weir
