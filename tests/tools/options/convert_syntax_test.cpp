#include "tools/options/convert_syntax.h"

#include <gtest/gtest.h>

#include <set>

#include "format/base/error.h"

namespace weir::convert_syntax_test {
namespace {

TEST(ConvertSyntaxOfTheCommand, ListsInputAndConversionOptions) {
  std::set<std::string> values;
  std::set<std::string> flags;
  for (const auto& [name, flag, path] : convert_syntax().options) {
    (flag ? flags : values).insert(name);
    EXPECT_EQ(path, name == "scene") << name;
  }
  EXPECT_EQ(values, (std::set<std::string>{"background", "brick",  "dataset", "dims",      "direct-io", "encoding",
                                           "endian",     "fill",   "index",   "max-error", "metric",    "missing",
                                           "nonfinite",  "offset", "origin",  "preset",    "psnr",      "rate",
                                           "roi",        "scene",  "size",    "spacing",   "type"}));
  EXPECT_EQ(flags, std::set<std::string>{"lossless"});
}

TEST(ConvertSyntaxOfTheCommand, ChecksAsTheCommandDoes) {
  const auto check = convert_syntax().check;
  EXPECT_NO_THROW(check({}));
  EXPECT_NO_THROW(check({"--rate=8", "--background=-5", "--origin=-1,-2,3", "--roi=0:8,0:8,0:8"}));
  const auto refusal = [&](const std::vector<std::string>& arguments) -> std::string {
    try {
      check(arguments);
      return "";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      return error.what();
    }
  };
  EXPECT_EQ(refusal({"--psnr=60", "--metric=farthest"}),
            "--metric farthest has no error target; --psnr and --max-error select by sse");
  EXPECT_EQ(refusal({"--endian=middle"}), "--endian is \"middle\", it must be little or big");
  EXPECT_EQ(refusal({"--help"}), "The following argument was not expected: --help");
}

}  // namespace
}  // namespace weir::convert_syntax_test
