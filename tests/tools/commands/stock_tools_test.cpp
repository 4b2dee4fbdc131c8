// Tests files that `weir convert` made with the stock NanoVDB command-line tools. The tools return exit code 0 even if
// they find a fault, so the tests check what the tools print.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "format/nanovdb/nvdb_file.h"
#include "tests/support/run_command.h"

namespace weir::stock_tools_test {
namespace {

bool is_installed(const std::string& program) {
  return run_command({"sh", "-c", "command -v " + program}).exit_code == 0;
}

class StockTools : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* program : {"nanovdb_validate", "nanovdb_print", "nanovdb_convert"})
      if (!is_installed(program)) GTEST_SKIP() << program << " is not installed (package libnanovdb-tools)";
  }

  /// Converts a synthetic volume of `dims` with `options`. Returns the file's path.
  std::string convert(const std::string& kind, const std::string& dims, const std::vector<std::string>& options) {
    const std::string raw = directory_ / "volume.raw";
    const std::string nvdb = directory_ / "volume.nvdb";
    const CommandResult sampled =
        run_weir({"sample", kind, "--dims", dims, "--type", "float32", "-o", raw, "--overwrite"});
    EXPECT_EQ(sampled.exit_code, 0) << sampled.err;
    std::vector<std::string> arguments{"convert", raw, "--dims", dims, "--type", "float32", "-o", nvdb, "--overwrite"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const CommandResult converted = run_weir(arguments);
    EXPECT_EQ(converted.exit_code, 0) << converted.err;
    return nvdb;
  }

  static void expect_valid(const std::string& nvdb) {
    const CommandResult result = run_command({"nanovdb_validate", "-v", nvdb});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(result.out, "\nThe file \"" + nvdb +
                              "\" contains the following matching 1 grid(s):\nGrid named \"density\": passed\n");
  }

  TemporaryDirectory directory_;
};

TEST_F(StockTools, ValidateEveryKindOfTree) {
  struct Case {
    const char* kind;
    const char* dims;
    std::vector<std::string> options;
  };
  const std::vector<Case> cases{
      {"noise", "1,1,1", {}},                                          // one leaf, the minimum tree
      {"turbulence", "150,100,40", {"--rate", "2"}},                   // extents that end inside leaves
      {"turbulence", "150,100,40", {"--lossless"}},                    // every leaf
      {"turbulence", "150,100,40", {"--size", "1000001"}},             // padding that is no multiple of 32
      {"turbulence", "150,100,40", {"--size", "9999999"}},             // most of it padding
      {"signed", "96,200,130", {"--preset", "paper"}},                 // dropped blocks are background
      {"zero", "300,20,20", {}},                                       // nothing worth keeping
      {"constant", "4100,8,8", {"--lossless"}},                        // two root tiles
      {"sphere", "257,129,140", {"--rate", "10", "--metric", "sse"}},  // homogeneous 128^3 regions
      {"turbulence", "140,90,70", {"--rate", "9", "--encoding", "fpn"}},
      {"noise", "130,60,61", {"--rate", "4", "--encoding", "fp4"}},
      {"cloud", "70,90,131", {"--rate", "3", "--encoding", "fp8"}},
      {"signed", "96,20,130", {"--rate", "2", "--encoding", "fp16"}},
      {"cloud", "150,100,40", {"--size", "700001", "--encoding", "auto"}},
      {"noise", "9,3,1", {"--size", "999999", "--encoding", "fpn"}},  // quantised leaves that overhang, and padding
      {"offset", "100,20,40", {"--lossless"}},                        // a lattice at 1e8
      {"huge", "64,64,64", {"--rate", "2"}},                          // statistics that overflow float32
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(std::string(c.kind) + ' ' + c.dims);
    expect_valid(convert(c.kind, c.dims, c.options));
  }
}

TEST_F(StockTools, ValidateSaysFailedWithExitCode0) {
  const std::string nvdb = convert("noise", "8,8,8", {});
  std::string damaged = read_file(nvdb);
  damaged.at(4096 + 3) ^= 1;  // in the grid's magic number
  write_file(nvdb, damaged);
  const CommandResult result = run_command({"nanovdb_validate", "-v", nvdb});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.out.find("Grid named \"density\": failed\n"), std::string::npos) << result.out;
}

TEST_F(StockTools, PrintShowsTheGrid) {
  const std::string nvdb =
      convert("turbulence", "150,100,40",
              {"--rate", "2", "--encoding", "float", "--spacing", "0.5,0.5,0.5", "--origin", "1,2,3"});
  const CommandResult result = run_command({"nanovdb_print", "-l", nvdb});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  // Name, type, version, codec, sizes, voxel size, nodes, index box, world box.
  const std::regex row(
      R"(\n1  density  float  \S+ +32\.4\.2 +NONE +1\.14\d MB +1\.14\d MB +\(0\.5,0\.5,0\.5\) +\d+ +150 x 100 x 40 )"
      R"(+1->2->\d+ +0->0->\d+ +\(0,0,0\) -> \(149,99,39\) +\(1,2,3\) -> \(76,52,23\))");
  EXPECT_TRUE(std::regex_search(result.out, row)) << result.out;
}

TEST_F(StockTools, PrintShowsQuantisedGrids) {
  for (const auto& [encoding, type] :
       {std::pair{"fpn", "FloatN"}, {"fp4", "Float4"}, {"fp8", "Float8"}, {"fp16", "Float16"}}) {
    const std::string nvdb = convert("turbulence", "150,100,40", {"--rate", "1.9", "--encoding", encoding});
    const CommandResult result = run_command({"nanovdb_print", "-l", nvdb});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    const std::regex row(std::string(R"(\n1  density  )") + type +
                         R"(  \S+ +32\.4\.2 +NONE +1\.2\d+ MB +1\.2\d+ MB +\(1,1,1\) +\d+ +150 x 100 x 40 )"
                         R"(+1->2->\d+ +\d+->\d+->\d+ +\(0,0,0\) -> \(149,99,39\) +\(0,0,0\) -> \(150,100,40\))");
    EXPECT_TRUE(std::regex_search(result.out, row)) << result.out;
  }
}

// The tool decodes a quantised grid with the stock reader and writes a float grid. Every voxel keeps its bits.
TEST_F(StockTools, ConvertToVdbAndBack) {
  for (const char* encoding : {"float", "fpn", "fp4", "fp8", "fp16"}) {
    for (const char* kind : {"turbulence", "signed", "offset"}) {
      SCOPED_TRACE(std::string(encoding) + ", " + kind);
      const std::string nvdb = convert(kind, "140,61,43", {"--rate", "2.2", "--encoding", encoding});
      const std::string vdb = directory_ / "volume.vdb";
      const std::string back = directory_ / "back.nvdb";
      for (const auto& [from, to] : {std::pair{nvdb, vdb}, {vdb, back}}) {
        const CommandResult result = run_command({"nanovdb_convert", "-f", from, to});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "");
      }
      expect_valid(back);
      const NvdbFile ours(nvdb);
      const NvdbFile theirs(back);
      EXPECT_EQ(theirs.grid().type(), GridType::float32);
      const Box domain{{0, 0, 0}, {140, 61, 43}};
      EXPECT_EQ(theirs.grid().index_bbox(), domain);
      EXPECT_EQ(theirs.grid().active_voxels(), ours.grid().active_voxels());
      std::int64_t differing = 0;
      for (std::int64_t n = 0; n < domain.voxels(); ++n) {
        const Index3 i = index_at(n, domain.extent());
        differing +=
            std::bit_cast<std::uint32_t>(ours.grid().value(i)) != std::bit_cast<std::uint32_t>(theirs.grid().value(i))
                ? 1
                : 0;
      }
      EXPECT_EQ(differing, 0);
    }
  }
}

}  // namespace
}  // namespace weir::stock_tools_test
