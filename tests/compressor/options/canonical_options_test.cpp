#include "compressor/options/canonical_options.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "compressor/options/conversion_request.h"

namespace weir::canonical_options_test {
namespace {

using Options = std::map<std::string, std::string>;

/// Texts with the same meaning, for each option of input and method. No text means the option's default.
const std::map<std::string, std::vector<std::string>> kSameTexts{
    {"dims", {"4,5,6", "4x5x6"}},
    {"type", {"float32", "float", "f4", "<f4"}},
    {"endian", {"big"}},
    {"offset", {"1KiB", "1024"}},
    {"dataset", {"/rho"}},
    {"index", {"3,0"}},
    {"component", {"x", "0"}},
    {"magnitude", {"u,v,w"}},
    {"level", {"1", "01"}},
    {"levels", {"separate"}},
    {"upsample", {"linear"}},
    {"missing-chunks", {"error"}},
    {"stack", {"true"}},
    {"spacing", {"1,2,3", "1.0,2e0,3"}},
    {"origin", {"1,2,3", "1.0,2,3"}},
    {"missing", {"-9999"}},
    {"missing-policy", {"keep"}},
    {"roi", {"0:4,1:,:-2", "00:4,1:,:-2"}},
    {"ghost", {"2", "2,2,2"}},
    {"nonfinite", {"background"}},
    {"size", {"1MiB", "1048576"}},
    {"rate", {"4", "4.0"}},
    {"psnr", {"60", "6e1"}},
    {"max-error", {"0.5", "5e-1"}},
    {"lossless", {"true"}},
    {"encoding", {"packed"}},
    {"metric", {"farthest"}},
    {"fill", {"background"}},
    {"background", {"0", "0.0"}},
    {"preset", {"paper"}},
};

TEST(CanonicalOptions, EveryOptionThatDecidesIsInThem_TheSameHoweverItIsWritten) {
  for (const auto table : {input_options(), method_options()}) {
    for (const ConversionOption& option : table) {
      const std::string key(option.row.key);
      // direct-io and certify do not change the file. brick needs another metric, at-most a size, preview packed
      // blocks, and scene a file.
      if (key == "direct-io" || key == "certify" || key == "brick" || key == "at-most" || key == "scene") continue;
      if (key == "preview") continue;
      ASSERT_TRUE(kSameTexts.contains(key)) << key;
      const std::vector<std::string>& texts = kSameTexts.at(key);
      const Options first = canonical_options({{key, texts.front()}});
      EXPECT_NE(first, canonical_options({})) << key;
      for (const std::string& text : texts) EXPECT_EQ(canonical_options({{key, text}}), first) << key << ' ' << text;
    }
  }
  EXPECT_NE(canonical_options({{"metric", "farthest"}, {"brick", "16"}}), canonical_options({{"metric", "farthest"}}));
  EXPECT_NE(canonical_options({{"encoding", "packed"}, {"preview", "off"}}),
            canonical_options({{"encoding", "packed"}}));
  EXPECT_NE(canonical_options({{"size", "1MiB"}, {"at-most", "true"}}), canonical_options({{"size", "1MiB"}}));
}

TEST(CanonicalOptions, WhatIsMeantWithoutAnOptionIsLeftOut) {
  EXPECT_EQ(canonical_options({{"encoding", "auto"}, {"metric", "sse"}, {"ghost", "0"}, {"at-most", "false"}}),
            canonical_options({}));
}

TEST(CanonicalOptions, MissingPolicyAuto_IsWhatNonfiniteSays) {
  EXPECT_EQ(canonical_options({{"missing-policy", "error"}}), canonical_options({}));
  EXPECT_EQ(canonical_options({{"missing-policy", "error"}, {"nonfinite", "error"}}), canonical_options({}));
  EXPECT_EQ(canonical_options({{"missing-policy", "background"}, {"nonfinite", "background"}}),
            canonical_options({{"nonfinite", "background"}}));
  EXPECT_NE(canonical_options({{"missing-policy", "keep"}, {"nonfinite", "keep"}}),
            canonical_options({{"nonfinite", "keep"}}));
}

}  // namespace
}  // namespace weir::canonical_options_test
