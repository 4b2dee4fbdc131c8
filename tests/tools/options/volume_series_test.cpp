#include "tools/options/volume_series.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "format/nanovdb/nvdb_file.h"
#include "tests/support/run_command.h"

namespace weir::volume_series_test {
namespace {

TEST(ExpandVolumes, NamesAndPatterns) {
  const TemporaryDirectory directory;
  for (const std::string name : {"s_1.nvdb", "s_2.nvdb", "s_10.nvdb", "t.nvdb", "[x].nvdb"})
    write_file(directory / name, "");
  const auto in = [&](const std::string& name) { return directory / name; };
  const auto expand = [](const std::vector<std::string>& inputs) { return expand_volumes(inputs); };
  using Paths = std::vector<std::string>;
  EXPECT_EQ(expand({in("s_*.nvdb")}), (Paths{in("s_1.nvdb"), in("s_2.nvdb"), in("s_10.nvdb")}));
  EXPECT_EQ(expand({in("t.nvdb"), in("s_10.nvdb"), in("s_?.nvdb"), in("s_[12].nvdb")}),
            (Paths{in("s_1.nvdb"), in("s_2.nvdb"), in("s_10.nvdb"), in("t.nvdb")}));
  EXPECT_EQ(expand({in("s_%d.nvdb")}), (Paths{in("s_1.nvdb"), in("s_2.nvdb"), in("s_10.nvdb")}));
  EXPECT_EQ(expand({in("s_%02d.nvdb")}), Paths{in("s_10.nvdb")});
  EXPECT_EQ(expand({in("[x].nvdb")}), Paths{in("[x].nvdb")}) << "a file of that name is no pattern";
  EXPECT_EQ(expand({in("missing.nvdb")}), Paths{in("missing.nvdb")}) << "an error when it is opened";
  try {
    expand({in("u*.nvdb")});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(error.what(), in("u*.nvdb") + ": no file has such a name; give files, or a pattern in quotes");
  }
}

TEST(SummariseSeries, RangeBackgroundAndBoxes) {
  const TemporaryDirectory directory;
  const auto make = [&](const std::string& name, const std::string& kind, const std::string& shape) {
    const std::string raw = directory / (kind + "_" + shape + "_float32.raw");
    EXPECT_EQ(run_weir({"sample", kind, "-o", raw, "--overwrite"}).exit_code, 0);
    EXPECT_EQ(run_weir({"convert", raw, "--lossless", "--nonfinite", "keep", "-o", directory / name}).exit_code, 0);
    return directory / name;
  };
  const std::string half = make("a.nvdb", "constant", "9x8x7");
  const std::string ramp = make("b.nvdb", "gradient", "9x8x7");
  const std::string holes = make("c.nvdb", "some-nan", "9x8x8");
  const std::string broken = directory / "d.nvdb";
  write_file(broken, "no volume");
  SeriesSummary summary = summarise_series(std::vector<std::string>{broken, half, ramp});
  ASSERT_TRUE(summary.range);
  EXPECT_EQ(summary.range->min, 0);
  EXPECT_EQ(summary.range->max, 1);
  EXPECT_EQ(summary.background, 0.5F);
  EXPECT_EQ(summary.difference, "");
  summary = summarise_series(std::vector<std::string>{half, holes});
  EXPECT_EQ(summary.range->min, 0.5F) << "a root with infinities names no range";
  EXPECT_EQ(summary.range->max, 0.5F);
  EXPECT_EQ(summary.difference,
            half + " has 9 x 8 x 7 voxels from 0,0,0, " + holes + " has 9 x 8 x 8 voxels from 0,0,0");
  summary = summarise_series(std::vector<std::string>{broken});
  EXPECT_FALSE(summary.range);
  EXPECT_FALSE(summary.background);
}

TEST(SummariseSeries, ReadsHeadsAlone) {
  const TemporaryDirectory directory;
  const std::string raw = directory / "v_9x8x7_float32.raw";
  ASSERT_EQ(run_weir({"sample", "gradient", "-o", raw}).exit_code, 0);
  ASSERT_EQ(run_weir({"convert", raw, "--lossless", "-o", directory / "v.nvdb"}).exit_code, 0);
  // All behind the second page, which ends past the root: nodes and leaves.
  std::string bytes = read_file(directory / "v.nvdb");
  ASSERT_GT(bytes.size(), 100'000U);
  std::fill(bytes.begin() + 8192, bytes.end(), '\xFF');
  write_file(directory / "v.nvdb", bytes);
  EXPECT_THROW(NvdbFile(directory / "v.nvdb"), Error);
  const SeriesSummary summary = summarise_series(std::vector<std::string>{directory / "v.nvdb"});
  ASSERT_TRUE(summary.range);
  EXPECT_EQ(summary.range->max, 1);
  EXPECT_EQ(summary.box, (Box{{0, 0, 0}, {9, 8, 7}}));
}

}  // namespace
}  // namespace weir::volume_series_test
