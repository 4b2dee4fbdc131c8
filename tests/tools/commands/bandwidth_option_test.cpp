#include <gtest/gtest.h>

#include <string>

#include "tests/support/run_command.h"

namespace weir::bandwidth_option_test {
namespace {

class BandwidthOptionTest : public testing::Test {
 protected:
  BandwidthOptionTest() {
    const auto made = run_weir({"sample", "cloud", "--dims", "64,64,64", "-o", source_});
    EXPECT_EQ(made.exit_code, 0) << made.err;
  }

  TemporaryDirectory directory_;
  std::string source_ = directory_ / "c_64x64x64_float32.raw";
};

TEST_F(BandwidthOptionTest, LimitedBandwidth_MakesTheSameBytesAndCountsAsDone) {
  const auto free = run_weir({"convert", source_, "-o", directory_ / "free.nvdb"});
  ASSERT_EQ(free.exit_code, 0) << free.err;
  const auto limited = run_weir({"convert", source_, "-o", directory_ / "limited.nvdb", "--bandwidth", "50MB"});
  ASSERT_EQ(limited.exit_code, 0) << limited.err;
  EXPECT_EQ(read_file(directory_ / "limited.nvdb"), read_file(directory_ / "free.nvdb"));
  const auto again = run_weir({"convert", source_, "-o", directory_ / "limited.nvdb", "--skip-done"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.err.find("limited.nvdb: done already"), std::string::npos) << again.err;
}

TEST_F(BandwidthOptionTest, RefusesInvalidBandwidths) {
  for (const std::string text : {"0", "fast", "-1"}) {
    const auto refused = run_weir({"convert", source_, "--bandwidth=" + text});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(refused.err, "weir: --bandwidth is \"" + text + "\", it must be a size above 0, like 200MB (a second)\n");
  }
}

}  // namespace
}  // namespace weir::bandwidth_option_test
