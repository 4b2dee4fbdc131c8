#include "tools/describe/man_examples.h"

#include <gtest/gtest.h>

#include <string>

#include "format/base/text.h"
#include "tests/support/run_command.h"

namespace weir::man_examples_test {
namespace {

// The help of a command must name each option that the command's examples use.
TEST(ManExamples, GiveOptionsThatTheirCommandsHave) {
  for (const ManExample& example : man_examples()) {
    const std::string name(example.command);
    if (name == "weir") continue;
    EXPECT_NE(example.line.find("weir " + name), std::string_view::npos) << example.line;
    const std::string help = run_weir({name, "--help"}).out;
    for (const std::string& word : split(std::string(example.line), ' ')) {
      if (!word.starts_with("--")) continue;
      EXPECT_NE(help.find("  " + word), std::string::npos) << word << " in: " << example.line;
    }
  }
}

}  // namespace
}  // namespace weir::man_examples_test
