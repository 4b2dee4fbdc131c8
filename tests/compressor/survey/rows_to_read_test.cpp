#include "compressor/survey/rows_to_read.h"

#include <gtest/gtest.h>

namespace weir {
namespace {

TEST(RowsToRead, SomeLeaves_AreWidenedToWholeRows) {
  RowsToRead rows({{2, 3, 4}, {10, 11, 12}});
  EXPECT_TRUE(rows.box().empty());
  rows.add({5, 6, 7});
  EXPECT_EQ(rows.box(), (Box{{2, 6, 7}, {10, 7, 8}}));
  rows.add({3, 10, 4});
  EXPECT_EQ(rows.box(), (Box{{2, 6, 4}, {10, 11, 8}}));
}

}  // namespace
}  // namespace weir
