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

TEST(ProblemKey, LeavesOutTheNamesOfOutputs) {
  const std::string key =
      "/out/*.nvdb: # bytes asked, the smallest tree for this volume takes #; ask for size # or more";
  const std::string rest =
      ": 4096 bytes asked, the smallest tree for this volume takes 309856; ask for size 309856 or more";
  EXPECT_EQ(problem_key("/run/rho.raw", "/out/rho.nvdb" + rest), key);
  EXPECT_EQ(problem_key("/run/vorticity_8x8x8_uint8.raw", "/out/vorticity_8x8x8_uint8.nvdb" + rest), key);
  EXPECT_EQ(problem_key("/run/brain.nii.gz", "/out/brain.nvdb" + rest), key);
  EXPECT_EQ(problem_key("/run/all.h5", "/out/all_density_3.nvdb" + rest), key);
  EXPECT_EQ(problem_key("/run/rho.raw", "/out/rho.nvdb.partial: cannot create: Permission denied"),
            "/out/*.nvdb.partial: cannot create: Permission denied");
}

TEST(ProblemKey, NamesThatBeginAsThatOfTheSource_Stay) {
  EXPECT_EQ(problem_key("/run/rho.raw", "/rhodium/other.nvdb: exists"), "/rhodium/other.nvdb: exists");
  EXPECT_EQ(problem_key("/run/rho.raw", "/rho/other.nvdb: exists"), "/rho/other.nvdb: exists");
  EXPECT_EQ(problem_key("/run/rho.raw", "no dataset /rho"), "no dataset /rho");
  EXPECT_EQ(problem_key("/run/.raw", "/out/.nvdb: exists"), "/out/.nvdb: exists");
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
