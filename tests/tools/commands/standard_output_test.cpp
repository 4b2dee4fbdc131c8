// Tests stdout for every command that reports there. A stdout that cannot be written to is an error. A reader that
// leaves early is none.
#include <gtest/gtest.h>

#include <string>

#include "tests/tools/support/converted_volume.h"

namespace weir::standard_output_test {
namespace {

class StandardOutput : public ConvertedVolume {
 protected:
  CommandResult run(const std::string& arguments, const std::string& into) const {
    CommandOptions options;
    options.directory = directory_.path();
    return run_command({"/bin/bash", "-c", std::string(WEIR_COMMAND) + ' ' + arguments + ' ' + into}, options);
  }
};

TEST_F(StandardOutput, DeviceIsFull_ExitsWith5) {
  for (const std::string arguments :
       {"inspect v.nvdb", "inspect --json v.nvdb", "inspect -q v_40x30x20_float32.raw", "verify v.nvdb -q",
        "verify --json v.nvdb -q", "compare --json v_40x30x20_float32.raw v.nvdb -q",
        "convert --json v_40x30x20_float32.raw -o again.nvdb --lossless -q",
        "convert --dry-run v_40x30x20_float32.raw -o none.nvdb --lossless -q",
        "play v.nvdb --raw - --backend cpu --size 8x8 -q", "--help", "convert --help", "--version", "help",
        "man --options"}) {
    const CommandResult result = run(arguments, ">/dev/full");
    EXPECT_EQ(result.exit_code, 5) << arguments;
    EXPECT_EQ(result.err,
              "weir: stdout: cannot write: No space left on device; free space there or redirect it to another file\n")
        << arguments;
  }
}

TEST_F(StandardOutput, ClosedBeforeTheStart_ExitsWith5) {
  const CommandResult result = run("--help", ">&-");
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(result.err, "weir: stdout: cannot write: Bad file descriptor; redirect it to a file or a program\n");
}

TEST_F(StandardOutput, ReaderThatLeaves_IsNoError) {
  const CommandResult result = run("man --options", "| true; exit ${PIPESTATUS[0]}");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
}

TEST_F(StandardOutput, CommandThatFailedAlready_KeepsItsExitCode) {
  const CommandResult result = run("verify none.nvdb -q", ">/dev/full");
  EXPECT_EQ(result.exit_code, 3);
}

}  // namespace
}  // namespace weir::standard_output_test
