// Tests the ways to ask for help.
#include <gtest/gtest.h>

#include <string>

#include "tests/support/run_command.h"

namespace weir::help_test {
namespace {

TEST(Help, AsAWord_IsWhatTheOptionSays) {
  const CommandResult all = run_weir({"help"});
  EXPECT_EQ(all.exit_code, 0);
  EXPECT_EQ(all.err, "");
  EXPECT_EQ(all.out, run_weir({"--help"}).out);
  EXPECT_NE(all.out.find("\n  convert "), std::string::npos) << all.out;
  const CommandResult convert = run_weir({"help", "convert"});
  EXPECT_EQ(convert.exit_code, 0);
  EXPECT_EQ(convert.err, "");
  EXPECT_EQ(convert.out, run_weir({"convert", "--help"}).out);
  EXPECT_NE(convert.out.find("--rate RATE"), std::string::npos) << convert.out;
}

TEST(Help, OfNoCommand_NamesTheOneThatWasMeant) {
  const CommandResult result = run_weir({"help", "covnert"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err, "weir: no command \"covnert\"; did you mean convert? see weir --help\n");
}

// An option that may be given several times takes one value each time.
TEST(Help, OptionThatMayBeRepeated_IsShownWithOneValue) {
  const std::string help = run_weir({"convert", "--help"}).out;
  EXPECT_NE(help.find("--dataset NAME "), std::string::npos) << help;
  EXPECT_EQ(help.find("--dataset NAME ..."), std::string::npos) << help;
  EXPECT_NE(help.find("may be given several times"), std::string::npos) << help;
}

TEST(Help, OfACommandThatReadsOneVolume_SaysNothingOfSeveral) {
  for (const std::string command : {"render", "compare", "view", "sweep", "inspect"}) {
    const std::string help = run_weir({command, "--help"}).out;
    if (help.find("(not in this build)") != std::string::npos) continue;
    EXPECT_NE(help.find("--dataset NAME "), std::string::npos) << command;
    EXPECT_NE(help.find("--level N "), std::string::npos) << command;
    EXPECT_EQ(help.find("--levels ") != std::string::npos, command == "compare") << "of the level that a file is of";
    for (const std::string text : {"a file of each", "several times", "FROM:TO"}) {
      EXPECT_EQ(help.find(text), std::string::npos) << command << ' ' << text;
    }
  }
}

TEST(Help, OfInspect_HasNoOptionThatChoosesAPart) {
  const std::string help = run_weir({"inspect", "--help"}).out;
  for (const std::string option : {"--index", "--component", "--magnitude", "--roi", "--ghost"}) {
    EXPECT_EQ(help.find(option + ' '), std::string::npos) << option;
  }
}

}  // namespace
}  // namespace weir::help_test
