// The conversion that several options request together.
#include "compressor/options/conversion_request.h"

#include <gtest/gtest.h>

namespace weir::conversion_request_test {
namespace {

TEST(ConversionRequest, EmptyText_IsNotGivenBesideWhatItWouldContradict) {
  const ConversionRequest quantised = read_conversion_request({{"preset", ""}, {"encoding", "fpn"}});
  EXPECT_EQ(quantised.conversion.encoding, Encoding::fpn);
  EXPECT_EQ(quantised.conversion.metric, Metric::sse);
  const ConversionRequest levels = read_conversion_request({{"levels", "separate"}, {"roi", ""}, {"spacing", ""}});
  EXPECT_EQ(levels.source.levels, Levels::separate);
}

}  // namespace
}  // namespace weir::conversion_request_test
