// Tests which files belong to one numbered series.
#include "ingest/files/numbered_series.h"

#include <filesystem>

#include "tests/ingest/support/scratch.h"

namespace weir::numbered_series_test {
namespace {

using Paths = std::vector<std::string>;

TEST(NumberedSeries, FilesWhoseNamesDifferInNumbersAlone) {
  const Scratch scratch;
  for (const char* name : {"s_10_8x8.raw", "s_9_8x8.raw", "s_9_16x8.raw", "s_u_9_8x8.raw", "s_9_8x8.raw.png", "t.raw",
                           ".s_9_8x8.raw", "[x] 1.raw"}) {
    scratch.write(name, {});
  }
  EXPECT_EQ(files_of_series(scratch.path("s_10_8x8.raw")),
            (Paths{scratch.path("s_9_8x8.raw"), scratch.path("s_9_16x8.raw"), scratch.path("s_10_8x8.raw")}));
  EXPECT_EQ(files_of_series(scratch.path("t.raw")), Paths{scratch.path("t.raw")});
  EXPECT_EQ(files_of_series(scratch.path("[x] 2.raw")), Paths{scratch.path("[x] 1.raw")}) << "no pattern";
  EXPECT_EQ(message_of_error(ErrorKind::io, [&] { files_of_series(scratch.path("none/a_1.raw")); }),
            scratch.path("none") + ": cannot read the directory: No such file or directory");
}

TEST(NumberedSeries, Key_IsOfTheDirectoryAndTheNameWithoutNumbers) {
  EXPECT_EQ(series_key("/a/s_1_2.raw"), series_key("/a/s_07_99.raw"));
  EXPECT_NE(series_key("/a/s_1.raw"), series_key("/b/s_1.raw"));
  EXPECT_NE(series_key("/a/s_1.raw"), series_key("/a/s_.raw"));
  EXPECT_NE(series_key("/a/s_1.raw"), series_key("/a/s_1_2.raw"));
  EXPECT_NE(series_key("/a1/s.raw"), series_key("/a2/s.raw")) << "numbers of directories count";
}

TEST(NumberedSeries, Digest_IsTheSameFromWhereverTheFileIsNamed) {
  const std::string here = (std::filesystem::current_path() / "s_1.nvdb").string();
  EXPECT_EQ(series_digest("s_2.nvdb"), series_digest(here));
  EXPECT_EQ(series_digest("x/../s_2.nvdb"), series_digest(here));
  EXPECT_NE(series_digest("t_2.nvdb"), series_digest(here));
  EXPECT_EQ(series_digest(here).size(), 32U);
}

}  // namespace
}  // namespace weir::numbered_series_test
