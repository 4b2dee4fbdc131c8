// Tests natural order and shell patterns.
#include "ingest/files/file_pattern.h"

#include "tests/ingest/support/scratch.h"

namespace weir::file_pattern_test {
namespace {

TEST(NaturalLess, ComparesRunsOfDigitsAsNumbers) {
  const std::vector<std::string> sorted{"",      "a",     "a0b", "a01",      "a1", "a1b",    "a2",     "a2b010",
                                        "a2b10", "a2b11", "a10", "a10.nvdb", "b",  "step_9", "step_10"};
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    for (std::size_t j = 0; j < sorted.size(); ++j)
      EXPECT_EQ(natural_less(sorted[i], sorted[j]), i < j) << i << ' ' << j;
  }
  EXPECT_TRUE(natural_less("step_009", "step_10"));
  EXPECT_TRUE(natural_less("1/2", "1/10"));
  EXPECT_TRUE(natural_less("step_99999999999999999998", "step_99999999999999999999")) << "larger than any integer";
}

TEST(FilePattern, Matches_InNaturalOrder) {
  const Scratch scratch;
  for (const char* name : {"s_10.raw", "s_9.raw", "t.raw", "[x].raw"}) scratch.write(name, {});
  EXPECT_EQ(matching_files(scratch.path("s_*.raw")),
            (std::vector<std::string>{scratch.path("s_9.raw"), scratch.path("s_10.raw")}));
  EXPECT_TRUE(is_file_pattern(scratch.path("s_?.raw")));
  EXPECT_FALSE(is_file_pattern(scratch.path("[x].raw"))) << "a file of that name is no pattern";
  EXPECT_FALSE(is_file_pattern(scratch.path("s_%02d.raw")));
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { matching_files(scratch.path("u*")); }),
            scratch.path("u*") + ": no file has such a name; give files, or a pattern in quotes");
}

}  // namespace
}  // namespace weir::file_pattern_test
