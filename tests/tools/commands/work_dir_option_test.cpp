// Tests that every command with --work-dir refuses a directory at its start if it cannot use the directory.
#include "tests/tools/support/converted_volume.h"

namespace weir::work_dir_option_test {
namespace {

using WorkDirOption = ConvertedVolume;

TEST_F(WorkDirOption, DirectoryThatCannotBeUsed_IsRefusedAtTheStart) {
  const bool serves = run_weir({"view", "--help"}).out.find("--work-dir") != std::string::npos;
  for (const std::string& command : {std::string("convert"), std::string("view")}) {
    if (command == "view" && !serves) continue;  // this build has no weir view
    const auto refused = [&](const std::string& chosen, int code, const std::string& reason) {
      std::vector<std::string> words{command, volume_, "--work-dir", chosen};
      if (command == "convert") words.insert(words.end(), {"-o", directory_ / "o.nvdb"});
      const CommandResult result = run_weir(words);
      EXPECT_EQ(result.exit_code, code) << command;
      EXPECT_EQ(result.err, "weir: --work-dir " + chosen + ": " + reason + "\n") << command;
      EXPECT_EQ(result.out, "") << command;
    };
    refused(directory_ / "none", 5, "does not exist; make it or choose another");
    refused(volume_, 2, "is a file; choose a directory");
  }
}

}  // namespace
}  // namespace weir::work_dir_option_test
