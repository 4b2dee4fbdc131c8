#include "tools/options/parser_wording.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/run_command.h"

namespace weir::parser_wording_test {
namespace {

TEST(ParserWording, ATextOfAnotherForm_Stays) {
  EXPECT_EQ(parser_wording("input is required"), "input is required");
  EXPECT_EQ(parser_wording(""), "");
}

TEST(ParserWording, AnotherNumberOfValues_IsCounted) {
  EXPECT_EQ(parser_wording("--a: At least 4 required but received 1"), "--a has 1 value, it takes 4");
  EXPECT_EQ(parser_wording("--a: At Most 4 required but received 5", [](const std::string&) { return "B C D E"; }),
            "--a has 5 values, it takes 4: B C D E");
}

TEST(ParserWording, ManyChoices_AreListedAsWeirDoes) {
  EXPECT_EQ(parser_wording("--progress: may be not in {auto,always,never}"),
            "--progress is \"may be\", it must be auto, always or never");
  EXPECT_EQ(parser_wording("--one: x not in {a}"), "--one is \"x\", it must be a");
}

TEST(ParserWording, ValueOfAnyLengthThatSaysWhatTheParserSays_IsNamedAsItIs) {
  const std::string value = "a: b not in range 1 to 2 not in {" + std::string(1 << 20, 'x');
  EXPECT_EQ(parser_wording("--progress: " + value + " not in {auto,never}"),
            "--progress is \"" + value + "\", it must be auto or never");
  EXPECT_EQ(parser_wording("--limit: Value " + value + " not in range 1 to 1000"),
            "--limit is \"" + value + "\", it must be a number from 1 to 1000");
  const CommandResult result = run_weir({"render", "a.nvdb", "-o", "a.png", "--volume", std::string(100000, '7')});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(result.err.ends_with("777\", it must be file or dense; see weir render --help\n"))
      << result.err.substr(0, 200);
}

// weir rewords the parser's messages. Another version of the parser may word them differently, and this test would
// fail.
TEST(ParserWording, EveryWrongValue_IsNamedWithWhatItMustBe) {
  const auto refused = [](const std::vector<std::string>& words) {
    const CommandResult result = run_weir(words);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(result.err.ends_with("; see weir " + words[0] + " --help\n")) << result.err;
    return result.err.substr(0, result.err.rfind("; see "));
  };
  EXPECT_EQ(refused({"retry", "abc"}), "weir: id is \"abc\", it must be a number");
  EXPECT_EQ(refused({"flip", "a.png", "b.png", "--ppd", "many"}), "weir: --ppd is \"many\", it must be a number");
  EXPECT_EQ(refused({"render", "a.nvdb", "-o", "a.png", "--spp"}), "weir: --spp needs a value, N");
  EXPECT_EQ(refused({"compare", "a.raw", "a.nvdb", "--vector", "b.raw", "b.nvdb"}),
            "weir: --vector has 2 values, it takes 4: V V.nvdb W W.nvdb");
  EXPECT_EQ(refused({"convert", "a.raw", "--dataset"}), "weir: --dataset needs a value, NAME");
  EXPECT_EQ(refused({"convert", "a.raw", "--rate", "3", "--rate", "4"}), "weir: --rate is given 2 times; give it once");
  EXPECT_EQ(refused({"render", "a.nvdb", "-o", "a.png", "--volume", "both"}),
            "weir: --volume is \"both\", it must be file or dense");
  EXPECT_EQ(refused({"jobs", "--limit", "0"}), "weir: --limit is \"0\", it must be a number from 1 to 1000");
  EXPECT_EQ(refused({"jobs", "--offset", "-1"}), "weir: --offset is \"-1\", it must be a number from 0 on");
  EXPECT_EQ(refused({"convert", "a.raw", "--within", "no/where"}),
            "weir: --within is \"no/where\", which does not exist; name a directory");
  EXPECT_EQ(refused({"convert", "a.raw", "--within", "/dev/null"}),
            "weir: --within is \"/dev/null\", which is a file; name a directory");
  EXPECT_EQ(refused({"convert", "a.raw", "--again"}), "weir: --again needs --skip-done");
}

// The parser would take the nearest number that it can hold.
TEST(ParserWording, IdOutOfRange_IsRefusedAsItWasGiven) {
  const auto said = [](const std::vector<std::string>& words) {
    const CommandResult result = run_weir(words);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    return result.err;
  };
  const std::string range = "\", it must be a number from 1 to 9223372036854775807\n";
  EXPECT_EQ(said({"retry", "99999999999999999999"}), "weir: id is \"99999999999999999999" + range);
  EXPECT_EQ(said({"cancel", "--", "-9223372036854775809"}), "weir: id is \"-9223372036854775809" + range);
  EXPECT_EQ(said({"cancel", "3", "0"}), "weir: id is \"0" + range);
}

}  // namespace
}  // namespace weir::parser_wording_test
