// Tests --quiet for every command.
#include <gtest/gtest.h>

#include <string>

#include "tests/support/run_command.h"

namespace weir::quiet_test {
namespace {

TEST(Quiet, SaysErrorsAlone) {
  const TemporaryDirectory directory;
  const std::string raw = directory.path() / "a_64x64x64_uint8.raw";
  ASSERT_EQ(run_weir({"sample", "cloud", "--dims", "64,64,64", "--type", "uint8", "-o", raw, "-q"}).exit_code, 0);
  const std::string volume = directory.path() / "a.nvdb";
  const CommandResult converted = run_weir({"convert", raw, "-o", volume, "--rate", "2", "--quiet"});
  EXPECT_EQ(converted.exit_code, 0);
  EXPECT_EQ(converted.err, "");
  EXPECT_EQ(converted.out, "");
  const CommandResult rendered =
      run_weir({"render", volume, "-o", directory.path() / "a.png", "--size", "8x8", "-q", "--backend", "cpu"});
  EXPECT_EQ(rendered.exit_code, 0);
  EXPECT_EQ(rendered.err, "");
  const CommandResult refused = run_weir({"convert", raw, "-o", volume, "--rate", "2", "--quiet"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("exists"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace weir::quiet_test
