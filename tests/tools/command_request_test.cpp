#include "tools/command_request.h"

#include <gtest/gtest.h>

#include "tools/command.h"

namespace weir::command_request_test {
namespace {

TEST(CommandRequest, IsWhatWasGiven) {
  const ConversionRequest request = command_request({{"dims", "4,3,2"}, {"rate", "5"}});
  EXPECT_EQ(request.source.extent, (Index3{4, 3, 2}));
  EXPECT_EQ(request.conversion.budget.rate, 5);
  EXPECT_TRUE(request.source.notice);
}

TEST(CommandRequest, SignalEndsUnpacking) { EXPECT_EQ(command_request({}).source.cancel, &interrupt_flag()); }

}  // namespace
}  // namespace weir::command_request_test
