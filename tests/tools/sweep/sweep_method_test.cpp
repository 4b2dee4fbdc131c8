#include "tools/sweep/sweep_method.h"

#include <gtest/gtest.h>

#include "format/base/error.h"
#include "tests/support/message_of_error.h"

namespace weir::sweep_method_test {
namespace {

template <typename Parse>
std::string refusal(const Parse& parse) {
  return message_of_error(ErrorKind::usage, [&] { parse(); });
}

TEST(SweepMethod, RatesInTheOrderGiven) {
  EXPECT_EQ(parse_rates("20,10,2.5,1e3"), (std::vector<double>{20, 10, 2.5, 1000}));
  EXPECT_EQ(parse_rates("0.5"), std::vector<double>{0.5});
}

TEST(SweepMethod, BadRates) {
  const auto bad = [](const std::string& part) {
    return "--rates holds \"" + part +
           "\", it must be positive numbers such as 20,10,8: dense float32 bytes / file bytes";
  };
  for (const std::string part : {"", "x", "0", "-1", "nan", "inf", "1e30", "1e-9", "8 ", "8x"}) {
    EXPECT_EQ(refusal([&] { parse_rates("4," + part); }), bad(part));
  }
  EXPECT_EQ(refusal([] { parse_rates(""); }), bad(""));
  EXPECT_EQ(refusal([] { parse_rates("8,4,8.0"); }), "--rates holds 8.0 twice; leave one of them out");
}

TEST(SweepMethod, ByName) {
  const std::vector<SweepMethod> methods = parse_sweep_methods("paper32,zfp,fpn");
  ASSERT_EQ(methods.size(), 3U);
  EXPECT_EQ(methods[0].options, (std::map<std::string, std::string>{{"preset", "paper"}, {"brick", "32"}}));
  EXPECT_TRUE(methods[1].is_zfp());
  EXPECT_FALSE(methods[2].is_zfp());
  EXPECT_EQ(refusal([] { parse_sweep_methods("auto,lzma"); }),
            "--methods names \"lzma\", choose from auto, packed, fpn, float, fp4, fp8, fp16, paper, paper32, zfp");
  EXPECT_EQ(refusal([] { parse_sweep_methods("auto,zfp,auto"); }), "--methods names auto twice; leave one of them out");
}

TEST(SweepMethod, MethodNamesSetTheConversionOptions) {
  const auto conversion = [](const char* name, const GivenOptions& given = {}) {
    return conversion_of(parse_sweep_methods(name).front(), given);
  };
  EXPECT_EQ(conversion("auto").encoding, Encoding::automatic);
  EXPECT_EQ(conversion("fp16").encoding, Encoding::fp16);
  EXPECT_EQ(conversion("fp16").metric, Metric::sse);
  EXPECT_EQ(conversion("auto", {{"nonfinite", "keep"}}).non_finite, NonFinitePolicy::keep);
  EXPECT_EQ(conversion("packed", {{"missing-policy", "background"}}).missing, MissingPolicy::background);
  const ConversionOptions paper = conversion("paper");
  EXPECT_EQ(paper.encoding, Encoding::float32);
  EXPECT_EQ(paper.metric, Metric::farthest);
  EXPECT_EQ(paper.fill, FillMode::background);
  EXPECT_TRUE(paper.paper_background);
  EXPECT_EQ(paper.brick, 8);
  EXPECT_EQ(conversion("paper32").brick, 32);
  EXPECT_EQ(refusal([&] {
              conversion("auto", {{"nonfinite", "drop"}});
            }),
            "--nonfinite is \"drop\", it must be error, background or keep");
}

}  // namespace
}  // namespace weir::sweep_method_test
