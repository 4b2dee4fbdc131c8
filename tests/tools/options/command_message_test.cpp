#include "tools/options/command_message.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <string>
#include <vector>

namespace weir::command_message_test {
namespace {

std::string message(const std::vector<std::string>& options, int errno_value) {
  CLI::App app;
  std::vector<std::string> texts(options.size());
  CLI::App* const command = app.add_subcommand("write");
  for (std::size_t i = 0; i < options.size(); ++i) command->add_option(options[i], texts[i]);
  app.parse("write");
  return command_message(app, io_error("a", "write", errno_value));
}

TEST(CommandMessage, FullDisk_OffersOptionsOfTheCommandAlone) {
  const std::string full = "a: cannot write: No space left on device; free space on that file system";
  EXPECT_EQ(message({}, ENOSPC), full);
  EXPECT_EQ(message({"-o,--output"}, ENOSPC), full + " or choose another with -o");
  EXPECT_EQ(message({"--work-dir"}, ENOSPC), full + " or choose another with --work-dir");
  EXPECT_EQ(message({"-o,--output", "--work-dir"}, ENOSPC), full + " or choose another with -o or --work-dir");
  EXPECT_EQ(message({"-o,--output"}, EDQUOT),
            "a: cannot write: Disk quota exceeded; free space on that file system or choose another with -o");
}

TEST(CommandMessage, AnyOtherError_IsSaidAsItIs) { EXPECT_EQ(message({}, EIO), io_error("a", "write", EIO).what()); }

}  // namespace
}  // namespace weir::command_message_test
