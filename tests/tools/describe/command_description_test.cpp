#include "tools/describe/command_description.h"

#include <gtest/gtest.h>

#include "tests/tools/support/described_app.h"

namespace weir::command_description_test {
namespace {

using Words = std::vector<std::string>;

TEST(CommandDescription, EveryShapeOfOption) {
  test::DescribedApp described;
  const std::vector<CommandDescription> commands = describe_commands(described.app);
  ASSERT_EQ(commands.size(), 3U);
  EXPECT_EQ(commands[0].name, "weir");
  EXPECT_EQ(commands[0].text, "Lets water through");
  ASSERT_EQ(commands[0].options.size(), 2U);
  EXPECT_EQ(commands[0].options[0].names, (Words{"-h", "--help"}));
  EXPECT_EQ(commands[0].options[1].names, Words{"--version"});
  EXPECT_EQ(commands[2].name, "measure");

  const CommandDescription& open = commands[1];
  EXPECT_EQ(open.name, "open");
  EXPECT_EQ(open.text, "Opens a gate: it's quick");
  EXPECT_EQ(open.footer, "Gates:\n  .upper  'first'");
  ASSERT_EQ(open.options.size(), 7U);
  const OptionDescription& gate = open.options[1];
  EXPECT_TRUE(gate.positional && gate.required && gate.repeated);
  EXPECT_EQ(gate.names, Words{"gate"});
  EXPECT_EQ(gate.argument, "GATE");
  const OptionDescription& width = open.options[2];
  EXPECT_TRUE(!width.positional && width.required && !width.repeated);
  EXPECT_EQ(width.names, (Words{"-w", "--width"}));
  EXPECT_EQ(width.argument, "METRES");
  EXPECT_EQ(width.text, "of the gap \\ in m");
  EXPECT_EQ(width.group, "Options");
  const OptionDescription& pace = open.options[3];
  EXPECT_EQ(pace.argument, "slow|fast");
  EXPECT_EQ(pace.choices, (Words{"slow", "fast"}));
  EXPECT_EQ(pace.default_value, "slow");
  const OptionDescription& side = open.options[4];
  EXPECT_EQ(side.choices, (Words{"left", "right"}));
  EXPECT_EQ(side.group, "Place");
  const OptionDescription& count = open.options[5];
  EXPECT_EQ(count.argument, "N");
  EXPECT_EQ(count.choices, Words{});
  const OptionDescription& quiet = open.options[6];
  EXPECT_EQ(quiet.argument, "");
  EXPECT_FALSE(quiet.required || quiet.repeated || quiet.positional);
}

}  // namespace
}  // namespace weir::command_description_test
