#include "format/base/share_text.h"

#include <gtest/gtest.h>

namespace weir::share_text_test {
namespace {

TEST(ShareText, IsToATenthOfAPercent) {
  EXPECT_EQ(share_text(0, 7), "0 %");
  EXPECT_EQ(share_text(1, 4), "25 %");
  EXPECT_EQ(share_text(1234, 8000), "15.4 %");
  EXPECT_EQ(share_text(7, 7), "100 %");
}

TEST(ShareText, FewAndAllButFew_AreNotNoneAndAll) {
  EXPECT_EQ(share_text(1, 1'000'000'000'000), "less than 0.1 %");
  EXPECT_EQ(share_text(999'999, 1'000'000), "more than 99.9 %");
}

}  // namespace
}  // namespace weir::share_text_test
