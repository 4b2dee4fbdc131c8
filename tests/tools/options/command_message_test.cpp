#include "tools/options/command_message.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <filesystem>
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

TEST(CommandMessage, FileThatIsNotThere_IsSaidWithARemedyWhereItsNameIsRelative) {
  const auto missing = [](const std::string& option, const std::string& named, const std::string& path) {
    CLI::App app;
    std::string text;
    app.add_subcommand("read")->add_option(option, text);
    std::vector<std::string> words{named, "read"};  // in reverse order, as parse() expects them
    if (option.starts_with("-")) words.insert(words.begin() + 1, option);
    app.parse(std::move(words));
    return command_message(app, io_error(path, "open", ENOENT));
  };
  const std::string absent = ": cannot open: No such file or directory";
  EXPECT_EQ(missing("input", "a.nvdb", "a.nvdb"), "a.nvdb" + absent + "; check the name and the current directory");
  EXPECT_EQ(missing("input", "/d/a.nvdb", "/d/a.nvdb"), "/d/a.nvdb" + absent);
  EXPECT_EQ(missing("input", "a.nvdb", "b.nvdb"), "b.nvdb" + absent);
  const std::string remedy = "; check the name and the current directory";
  EXPECT_EQ(missing("--scene", "a.toml", "a.toml"), "a.toml" + absent + remedy);
  EXPECT_EQ(missing("--work-dir", "no", "no/view-1"), "no/view-1" + absent + remedy);
  EXPECT_EQ(missing("--work-dir", "no", "none"), "none" + absent);
  const std::string resolved = (std::filesystem::current_path() / "a.toml").string();
  EXPECT_EQ(missing("config", "./a.toml", resolved), resolved + absent + remedy);
}

TEST(CommandMessage, AnyOtherError_IsSaidAsItIs) { EXPECT_EQ(message({}, EIO), io_error("a", "write", EIO).what()); }

}  // namespace
}  // namespace weir::command_message_test
