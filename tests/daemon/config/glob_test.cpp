#include "daemon/config/glob.h"

#include <gtest/gtest.h>

#include <string>

namespace weir::glob_test {
namespace {

TEST(Glob, StarsAndQuestionMarksStopAtSlashes) {
  EXPECT_TRUE(matches_glob("*.raw", "a.raw"));
  EXPECT_FALSE(matches_glob("*.raw", "a.raw2"));
  EXPECT_FALSE(matches_glob("*.raw", "b/a.raw"));
  EXPECT_TRUE(matches_glob("*/*.raw", "b/a.raw"));
  EXPECT_TRUE(matches_glob("a*b*c", "aXbYbZc"));
  EXPECT_FALSE(matches_glob("a*b*c", "aXbYbZ"));
  EXPECT_TRUE(matches_glob("step_????.h5", "step_0042.h5"));
  EXPECT_FALSE(matches_glob("step_????.h5", "step_042.h5"));
  EXPECT_FALSE(matches_glob("a?b", "a/b"));
  EXPECT_TRUE(matches_glob("", ""));
  EXPECT_TRUE(matches_glob("*", ""));
  EXPECT_FALSE(matches_glob("", "a"));
  EXPECT_FALSE(matches_glob("a", "a/b"));
  EXPECT_FALSE(matches_glob("a/b", "a"));
}

TEST(Glob, Sets) {
  EXPECT_TRUE(matches_glob("[a-c]x[!0-9]", "bx_"));
  EXPECT_FALSE(matches_glob("[a-c]x[!0-9]", "bx7"));
  EXPECT_FALSE(matches_glob("[a-c]", "d"));
  EXPECT_TRUE(matches_glob("[]]", "]"));
  EXPECT_TRUE(matches_glob("[!]]", "a"));
  EXPECT_FALSE(matches_glob("[^]]", "]"));
  EXPECT_TRUE(matches_glob("[a-]", "-"));
  EXPECT_TRUE(matches_glob("[ab", "[ab"));  // an unclosed set is a literal bracket
  EXPECT_TRUE(matches_glob("[\x80-\xff]", "\xe9"));
  EXPECT_TRUE(matches_glob("\\*\\[\\\\", "*[\\"));
  EXPECT_FALSE(matches_glob("\\*", "a"));
}

TEST(Glob, TwoStarsMatchAnyNumberOfDirectories) {
  EXPECT_TRUE(matches_glob("**/a.raw", "a.raw"));
  EXPECT_TRUE(matches_glob("**/a.raw", "x/y/a.raw"));
  EXPECT_TRUE(matches_glob("run*/**/out/*.h5", "run1/out/a.h5"));
  EXPECT_TRUE(matches_glob("run*/**/out/*.h5", "run1/out/out/x/out/a.h5"));
  EXPECT_FALSE(matches_glob("run*/**/out/*.h5", "run1/x/a.h5"));
  EXPECT_TRUE(matches_glob("a/**", "a/b/c"));
  EXPECT_TRUE(matches_glob("a/**", "a"));
  EXPECT_FALSE(matches_glob("a/**", "b/a"));
  EXPECT_TRUE(matches_glob("**/x/**/y", "x/x/z/y/y"));
  EXPECT_TRUE(matches_glob("a**b", "aXXb"));  // not a component of its own, so it is a star
}

TEST(Glob, HiddenNamesMatchOnlyPatternsWithADot) {
  EXPECT_FALSE(matches_glob("*", ".a"));
  EXPECT_FALSE(matches_glob("?a", ".a"));
  EXPECT_FALSE(matches_glob("[.]a", ".a"));
  EXPECT_TRUE(matches_glob(".*", ".a"));
  EXPECT_TRUE(matches_glob("\\.a", ".a"));
  EXPECT_FALSE(matches_glob("**/a", ".x/a"));
  EXPECT_TRUE(matches_glob(".x/**", ".x/a"));
}

TEST(Glob, LongNamesAndManyStarsAreMatchedQuickly) {
  const std::string name(100000, 'a');
  EXPECT_FALSE(matches_glob("*a*a*a*a*a*a*a*a*b", name));
  std::string deep;
  for (int i = 0; i < 2000; ++i) deep += "d/";
  EXPECT_FALSE(matches_glob("**/d/**/d/**/d/**/x", deep + "y"));
}

}  // namespace
}  // namespace weir::glob_test
