#include "daemon/config/convert_syntax.h"

#include <gtest/gtest.h>

namespace weir::convert_syntax_test {
namespace {

const std::string kPath = "/etc/weir/c.toml";
using Arguments = std::vector<std::string>;

ConvertSyntax syntax(const std::string& refusal = "", ErrorKind kind = ErrorKind::usage) {
  ConvertSyntax syntax;
  syntax.options = {{"max-error", false, false},
                    {"dims", false, false},
                    {"lossless", true, false},
                    {"rate", false, false},
                    {"scene", false, true}};
  syntax.check = [refusal, kind](const Arguments&) {
    if (!refusal.empty()) throw Error(kind, refusal);
  };
  return syntax;
}

Arguments read(const std::string& text, const ConvertSyntax& known = syntax()) {
  const toml::table table = parse_toml(text, kPath);
  TomlReader reader(table, "[[watch]]", kPath);
  const Arguments arguments = read_convert_options(reader, table, known);
  reader.finish();
  return arguments;
}

std::string refusal(const std::string& text, const ConvertSyntax& known = syntax()) {
  try {
    read(text, known);
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
}

TEST(ConvertSyntax, KeysBecomeCommandLineOptions) {
  EXPECT_EQ(read(""), Arguments{});
  EXPECT_EQ(read("rate = 8\nlossless = true\ndims = '64,64,64'\nmax_error = 'x'"),
            (Arguments{"--max-error=x", "--dims=64,64,64", "--lossless", "--rate=8"}));
  EXPECT_EQ(read("lossless = false"), Arguments{});
}

TEST(ConvertSyntax, RelativePathsStartAtTheConfigurationFile) {
  EXPECT_EQ(read("scene = 'looks/a.toml'"), Arguments{"--scene=/etc/weir/looks/a.toml"});
  EXPECT_EQ(read("scene = '../a.toml'"), Arguments{"--scene=/etc/a.toml"});
  EXPECT_EQ(read("scene = '/a.toml'"), Arguments{"--scene=/a.toml"});
}

TEST(ConvertSyntax, NumbersKeepAllTheirDigits) {
  EXPECT_EQ(read("rate = 9007199254740993"), Arguments{"--rate=9007199254740993"});
  EXPECT_EQ(read("rate = -0.1"), Arguments{"--rate=-0.1"});
  EXPECT_EQ(read("rate = 1e-16"), Arguments{"--rate=1e-16"});
  EXPECT_EQ(read("rate = nan"), Arguments{"--rate=nan"});
  EXPECT_EQ(read("rate = -inf"), Arguments{"--rate=-inf"});
  EXPECT_EQ(read("dims = [64, 32, 0.5]"), Arguments{"--dims=64,32,0.5"});
  EXPECT_EQ(read("dims = ['0:8', 2]"), Arguments{"--dims=0:8,2"});
}

TEST(ConvertSyntax, RefusesWrongTypesAndUnknownKeys) {
  EXPECT_EQ(refusal("lossless = 1"), "/etc/weir/c.toml:1:12: lossless must be true or false");
  EXPECT_EQ(refusal("max_error = true"),
            "/etc/weir/c.toml:1:13: max_error must be a string, a number or an array of them");
  EXPECT_EQ(refusal("dims = []"), "/etc/weir/c.toml:1:8: dims must be a string, a number or an array of them");
  EXPECT_EQ(refusal("dims = [[1], 2]"), "/etc/weir/c.toml:1:9: dims must not be an array of arrays");
  EXPECT_EQ(refusal("dims = 1979-05-27"), "/etc/weir/c.toml:1:8: dims must be a string, a number or an array of them");
  EXPECT_EQ(
      refusal("max-error = 1"),
      "/etc/weir/c.toml:1:1: unknown key \"max-error\" in [[watch]]; there are dims, lossless, max_error, rate, scene");
}

TEST(ConvertSyntax, RefusalNamesThePlaceOfItsKey) {
  const ConvertSyntax known = syntax("--rate, --max-error and --max exclude each other --lossless");
  const std::string message = "rate, max_error and --max exclude each other lossless";
  EXPECT_EQ(refusal("max_error = 1\nrate = 8\ndims = 3", known), "/etc/weir/c.toml:2:8: " + message);
  EXPECT_EQ(refusal("rate = 8\nmax_error = 1\ndims = 3", known), "/etc/weir/c.toml:2:13: " + message);
  EXPECT_EQ(refusal("dims = 3", known), "/etc/weir/c.toml:1:1: " + message);
}

TEST(ConvertSyntax, ErrorsOtherThanUsage_PassUnchanged) {
  EXPECT_THROW(
      {
        try {
          read("rate = 8", syntax("--rate is odd", ErrorKind::internal));
        } catch (const Error& error) {
          EXPECT_EQ(error.kind(), ErrorKind::internal);
          EXPECT_STREQ(error.what(), "--rate is odd");
          throw;
        }
      },
      Error);
}

}  // namespace
}  // namespace weir::convert_syntax_test
