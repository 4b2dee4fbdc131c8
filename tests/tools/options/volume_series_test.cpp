#include "tools/options/volume_series.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "format/layout/nanovdb_layout.h"
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
  const auto certified = nlohmann::json::parse(read_file(holes + ".json"))["value_range"];
  EXPECT_EQ(summary.range->min, std::min(0.5F, certified[0].get<float>())) << "where the root names infinities";
  EXPECT_EQ(summary.range->max, std::max(0.5F, certified[1].get<float>()));
  EXPECT_LT(summary.range->min, summary.range->max);
  EXPECT_EQ(summary.without_range, "");
  std::filesystem::remove(holes + ".json");
  const SeriesSummary uncertified = summarise_series(std::vector<std::string>{half, holes});
  EXPECT_EQ(uncertified.range->min, 0.5F) << "infinities in every macrocell";
  EXPECT_EQ(uncertified.range->max, 0.5F);
  EXPECT_EQ(uncertified.without_range, holes);
  EXPECT_EQ(summary.difference,
            half + " has 9 x 8 x 7 voxels from 0,0,0, " + holes + " has 9 x 8 x 8 voxels from 0,0,0");
  summary = summarise_series(std::vector<std::string>{broken});
  EXPECT_FALSE(summary.range);
  EXPECT_FALSE(summary.background);
}

TEST(SummariseSeries, OtherVoxelSizesAndOrigins) {
  const TemporaryDirectory directory;
  const std::string raw = directory / "v_9x8x7_float32.raw";
  ASSERT_EQ(run_weir({"sample", "gradient", "-o", raw}).exit_code, 0);
  const auto make = [&](const std::string& name, const std::string& spacing, const std::string& origin) {
    EXPECT_EQ(run_weir({"convert", raw, "--lossless", "--spacing", spacing, "--origin", origin, "-o", directory / name})
                  .exit_code,
              0);
    return directory / name;
  };
  const std::string a = make("a.nvdb", "1,1,1", "0,0,0");
  const std::string b = make("b.nvdb", "1,1,6", "0,0,0");
  const std::string c = make("c.nvdb", "1,1,1", "500,0,0");
  EXPECT_EQ(summarise_series(std::vector<std::string>{a, a}).difference, "");
  EXPECT_EQ(summarise_series(std::vector<std::string>{a, b, c}).difference,
            a + " has voxels of 1 x 1 x 1 from 0,0,0, " + b + " has voxels of 1 x 1 x 6 from 0,0,0");
  EXPECT_EQ(summarise_series(std::vector<std::string>{a, c}).difference,
            a + " has voxels of 1 x 1 x 1 from 0,0,0, " + c + " has voxels of 1 x 1 x 1 from 500,0,0");
}

// OpenVDB's tools can leave files without statistics. The minimum and maximum in the root are no values then.
TEST(SummariseSeries, FilesWithoutStatistics) {
  const TemporaryDirectory directory;
  const std::string raw = directory / "v_9x8x7_float32.raw";
  const std::string path = directory / "v.nvdb";
  ASSERT_EQ(run_weir({"sample", "gradient", "-o", raw}).exit_code, 0);
  ASSERT_EQ(run_weir({"convert", raw, "--lossless", "-o", path}).exit_code, 0);
  std::string bytes = read_file(path);
  const std::uint64_t at = NvdbFile(path).grid().grid_offset() + nvdb::grid::kFlags;
  bytes[at] = static_cast<char>(bytes[at] & ~static_cast<int>(nvdb::grid::kFlagMinMax));
  write_file(path, bytes);
  EXPECT_TRUE(std::isnan(NvdbFile(path).grid().value_min()));
  EXPECT_TRUE(std::isnan(NvdbFile(path).grid().value_max()));
  SeriesSummary summary = summarise_series(std::vector<std::string>{path});
  ASSERT_TRUE(summary.range);
  EXPECT_EQ(summary.range->min, 0) << "of the macrocells, since the sidecar is of other bytes";
  EXPECT_EQ(summary.range->max, 1);
  EXPECT_EQ(summary.without_range, "");
}

TEST(SummariseSeries, ReadsHeadsAlone) {
  const TemporaryDirectory directory;
  const std::string raw = directory / "v_9x8x7_float32.raw";
  ASSERT_EQ(run_weir({"sample", "gradient", "-o", raw}).exit_code, 0);
  ASSERT_EQ(run_weir({"convert", raw, "--lossless", "-o", directory / "v.nvdb"}).exit_code, 0);
  // Overwrites nodes and leaves: all bytes after the second page, which ends behind the root.
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
