#include "format/io/file_time.h"

#include <gtest/gtest.h>

#include "format/sidecar/sidecar.h"

namespace weir::file_time_test {
namespace {

TEST(FileTime, NanosecondsSince1970) {
  EXPECT_EQ(nanoseconds_of(0, 0), 0);
  EXPECT_EQ(nanoseconds_of(951782400, 123456789), 951782400123456789);
  EXPECT_EQ(nanoseconds_of(-1, 999999999), -1);
  EXPECT_EQ(utc_text(nanoseconds_of(9223372036, 0)), "2262-04-11T23:47:16.000000000Z");
}

TEST(FileTime, BeyondInt64Nanoseconds_IsClamped) {
  EXPECT_EQ(utc_text(nanoseconds_of(9223372036, 999999999)), "2262-04-11T23:47:16.854775807Z");
  EXPECT_EQ(utc_text(nanoseconds_of(32503680000, 5)), "2262-04-11T23:47:16.854775807Z");
  EXPECT_EQ(utc_text(nanoseconds_of(-32503680000, 5)), "1677-09-21T00:12:43.145224192Z");
}

}  // namespace
}  // namespace weir::file_time_test
