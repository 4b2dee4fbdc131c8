#include "daemon/store/problem_key.h"

#include <gtest/gtest.h>

namespace weir::problem_key_test {
namespace {

TEST(ProblemKey, LeavesOutThePathAndTheFigures) {
  const std::string key =
      problem_key("/run/step_12_8x8x8_uint8.raw", "/run/step_12_8x8x8_uint8.raw: has 100 bytes and should have 512");
  EXPECT_EQ(key, "has # bytes and should have #");
  EXPECT_EQ(problem_key("/run/step_7.raw", "has 99 bytes and should have 4096"), key);
}

TEST(ProblemKey, LeavesOutThePathInsideTheText) {
  EXPECT_EQ(problem_key("/run/a.h5", "verify: /out/a.h5.nvdb: damaged; made of /run/a.h5"),
            "verify: /out/*.nvdb: damaged; made of *");
}

TEST(ProblemKey, ReplacesTheFileNameOnlyAsAWholeWord) {
  EXPECT_EQ(problem_key("/run/a", "/run/a: has a bad head"), "has * bad head");
}

TEST(ProblemKey, DifferentProblemsStayDifferent) {
  EXPECT_NE(problem_key("/a", "/a: is empty"), problem_key("/a", "/a: is no HDF5 file"));
  EXPECT_EQ(problem_key("", "12 of 3.5"), "# of #.#");
  EXPECT_EQ(problem_key("/a", ""), "no reason");
  EXPECT_EQ(problem_key("/a", "/a: names \xff\xc3\xa4"), "names ???");
}

TEST(WithoutPath, RemovesThePathOnlyAtTheFront) {
  EXPECT_EQ(without_path("/a/b", "/a/b: is empty"), "is empty");
  EXPECT_EQ(without_path("/a/b", "/a/bc: is empty"), "/a/bc: is empty");
  EXPECT_EQ(without_path("", ": x"), ": x");
}

}  // namespace
}  // namespace weir::problem_key_test
