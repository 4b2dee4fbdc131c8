#include "format/base/error.h"

#include <gtest/gtest.h>

namespace weir::error_test {
namespace {

TEST(Error, Reason_HasNoPlaceBeforeIt) {
  EXPECT_EQ(reason_of(input_error("a.h5: /v", "is damaged"), "a.h5: /v"), "is damaged");
  EXPECT_EQ(reason_of(input_error("a.h5.part", "is damaged"), "a.h5"), "a.h5.part: is damaged");
}

}  // namespace
}  // namespace weir::error_test
