// Tests grids of every type and shape that weir writes as .vdb and OpenVDB reads.
#include "tools/export/vdb_writer.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>

#include "format/base/error.h"
#include "format/layout/nanovdb_layout.h"
#include "ingest/vdb/vdb_header.h"
#include "tests/stock/stock_nvdb.h"
#include "tests/stock/vdb_oracle.h"
#include "tests/support/faulty_file_system.h"
#include "tests/support/temporary_directory.h"
#include "tools/export/vdb_node_values.h"

namespace weir::vdb_writer_test {
namespace {

constexpr std::uint32_t kCompressions[] = {0, kVdbZip, kVdbBlosc};

class VdbWriter : public testing::Test {
 protected:
  VdbWritten write(const NvdbGrid& grid, const VdbWriterOptions& options) {
    const auto file = files_->create(path_);
    return write_vdb(grid, "in.nvdb", options, *file);
  }

  /// Returns a sample file with `value` at byte `offset` of its grid.
  template <typename T>
  static std::vector<std::byte> patched(std::uint64_t offset, const T& value) {
    std::vector<std::byte> bytes = test::StockNvdb(GridType::float32).file();
    const std::uint64_t begin = NvdbGrid::open(bytes, "in.nvdb").grid_offset();
    std::memcpy(bytes.data() + begin + offset, &value, sizeof value);
    return bytes;
  }

  std::string refusal(const std::vector<std::byte>& bytes, const VdbWriterOptions& options, ErrorKind kind) {
    try {
      write(NvdbGrid::open(bytes, "in.nvdb"), options);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind);
      return error.what();
    }
    return "none";
  }

  TemporaryDirectory directory_;
  std::string path_ = directory_ / "out.vdb";
  std::unique_ptr<FileSystem> files_ = make_posix_file_system();
};

constexpr std::uint64_t kMatrix = nvdb::grid::kMap + 88;  ///< offset of the map's matrix of doubles

TEST_F(VdbWriter, EveryTypeAndCompressionBitForBit) {
  for (const GridType type : {GridType::float32, GridType::fp4, GridType::fp8, GridType::fp16, GridType::fpn}) {
    const std::vector<std::byte> bytes = test::StockNvdb(type).file();
    const NvdbGrid grid = NvdbGrid::open(bytes, "in.nvdb");
    for (const std::uint32_t compression : kCompressions) {
      if (compression != kVdbBlosc && type != GridType::float32)
        continue;  // other compressions do the same for all types
      SCOPED_TRACE(cat(grid_type_name(type), ", compression ", compression));
      VdbWriterOptions options;
      options.compression = compression;
      const VdbWritten written = write(grid, options);
      EXPECT_EQ(test::difference(grid, path_), "");
      EXPECT_EQ(written.bytes, files_->open(path_)->size());
      EXPECT_EQ(written.active_voxels, grid.active_voxels());
      EXPECT_EQ(written.topology.nodes[0], grid.node_counts()[0]);
      EXPECT_EQ(written.half_max_abs_error, 0);
    }
  }
}

TEST_F(VdbWriter, HalfRoundsToNearestAndSaysTheLargestError) {
  for (const GridType type : {GridType::float32, GridType::fpn}) {
    const std::vector<std::byte> bytes = test::StockNvdb(type).file();
    const NvdbGrid grid = NvdbGrid::open(bytes, "in.nvdb");
    for (const std::uint32_t compression : kCompressions) {
      VdbWriterOptions options;
      options.compression = compression;
      options.half = true;
      const VdbWritten written = write(grid, options);
      double worst = 0;
      EXPECT_EQ(test::difference(grid, path_,
                                 [&](float value) {
                                   const float half = rounded_to_half(value);
                                   worst = std::max(worst, std::abs(static_cast<double>(half) - value));
                                   return half;
                                 }),
                "");
      EXPECT_EQ(written.half_max_abs_error, worst);
      EXPECT_GT(worst, 1e-5);
      const test::VdbFacts facts = test::read_facts(path_);
      EXPECT_TRUE(facts.half);
      EXPECT_EQ(facts.metadata.at("is_saved_as_half_float"), "true");
    }
  }
}

TEST_F(VdbWriter, HeadHoldsNameCreatorMapAndMetadata) {
  const std::vector<std::byte> bytes = test::StockNvdb(GridType::float32).file();
  VdbWriterOptions options;
  options.creator = "weir 9.9";
  options.metadata = {{"note", "ok"}, {"share", 0.5}, {"kept", true}};
  const VdbWritten written = write(NvdbGrid::open(bytes, "in.nvdb"), options);
  EXPECT_FALSE(written.level_set);
  const test::VdbFacts facts = test::read_facts(path_);
  EXPECT_EQ(facts.name, "sample");
  EXPECT_EQ(facts.creator, "weir 9.9");
  EXPECT_FALSE(facts.half);
  EXPECT_EQ(facts.map, "UniformScaleTranslateMap");
  EXPECT_EQ(facts.origin, (std::array<double, 3>{10, 20, 30}));
  EXPECT_EQ(facts.steps[1], (std::array<double, 3>{0, 0.5, 0}));
  EXPECT_EQ(facts.metadata, (std::map<std::string, std::string>{{"class", "fog volume"},
                                                                {"file_bbox_max", "[4102, 8191, 4095]"},
                                                                {"file_bbox_min", "[-8192, -5, -20]"},
                                                                {"file_voxel_count", cat(written.active_voxels)},
                                                                {"is_saved_as_half_float", "false"},
                                                                {"kept", "true"},
                                                                {"name", "sample"},
                                                                {"note", "ok"},
                                                                {"share", "0.5"}}));
}

TEST_F(VdbWriter, LevelSetsStayLevelSets) {
  const auto bytes = patched(nvdb::grid::kGridClass, std::uint32_t{1});
  EXPECT_TRUE(write(NvdbGrid::open(bytes, "in.nvdb"), {}).level_set);
  EXPECT_EQ(test::read_facts(path_).metadata.at("class"), "level set");
}

TEST_F(VdbWriter, TransformsThatAreNotUniform) {
  const auto stretched = patched(kMatrix, std::array<double, 9>{1e-6, 0, 0, 0, 2e-6, 0, 0, 0, 5e-7});
  write(NvdbGrid::open(stretched, "in.nvdb"), {});
  test::VdbFacts facts = test::read_facts(path_);
  EXPECT_EQ(facts.map, "ScaleTranslateMap");
  EXPECT_NEAR(facts.steps[0][0], 1e-6, 1e-14);
  EXPECT_NEAR(facts.steps[2][2], 5e-7, 1e-14);

  // A quarter turn about z, and twice as long along z: world x = -y, y = x.
  const auto turned = patched(kMatrix, std::array<double, 9>{0, -1, 0, 1, 0, 0, 0, 0, 2});
  write(NvdbGrid::open(turned, "in.nvdb"), {});
  facts = test::read_facts(path_);
  EXPECT_EQ(facts.map, "AffineMap");
  EXPECT_EQ(facts.origin, (std::array<double, 3>{10, 20, 30}));
  EXPECT_EQ(facts.steps[0], (std::array<double, 3>{0, 1, 0}));
  EXPECT_EQ(facts.steps[1], (std::array<double, 3>{-1, 0, 0}));
  EXPECT_EQ(facts.steps[2], (std::array<double, 3>{0, 0, 2}));
}

TEST_F(VdbWriter, TransformsThatOpenVdbCannotRead) {
  EXPECT_EQ(refusal(patched(kMatrix, 0.0), {}, ErrorKind::input),
            "in.nvdb: its map is not finite or has a voxel size of 0");
  EXPECT_EQ(refusal(patched(kMatrix, std::array<double, 9>{0, -1e-5, 0, 1e-5, 0, 0, 0, 0, 1e-5}), {}, ErrorKind::input),
            "in.nvdb: its rotated map has a determinant of 1e-15, and OpenVDB reads none below 3e-15; give larger "
            "voxels or no rotation");
}

TEST_F(VdbWriter, ValuesThat16BitsCannotHold) {
  VdbWriterOptions options;
  options.half = true;
  const std::uint64_t background = nvdb::kRootOffset + nvdb::root::kBackground;
  EXPECT_EQ(refusal(patched(background, 65520.0F), options, ErrorKind::usage),
            "in.nvdb: --half holds values up to 65504, and one is 65520; leave --half out");
  const auto infinite = patched(background, -std::numeric_limits<float>::infinity());
  write(NvdbGrid::open(infinite, "in.nvdb"), options);  // infinity is infinite in 16 bits, too
  EXPECT_EQ(test::difference(NvdbGrid::open(infinite, "in.nvdb"), path_, rounded_to_half), "");
}

TEST_F(VdbWriter, ProgressEndsAtOneAndCanStop) {
  const std::vector<std::byte> bytes = test::StockNvdb(GridType::fp8).file();
  const NvdbGrid grid = NvdbGrid::open(bytes, "in.nvdb");
  double last = 0;
  int releases = 0;
  VdbWriterOptions options;
  options.progress = [&](double share) {
    EXPECT_GE(share, last);
    last = share;
  };
  options.release_pages = [&] { ++releases; };
  write(grid, options);
  EXPECT_EQ(last, 1);
  EXPECT_GE(releases, 1);
  options.progress = [](double) { throw Error(ErrorKind::interrupted, "stop"); };
  EXPECT_EQ(refusal(bytes, options, ErrorKind::interrupted), "stop");
}

TEST_F(VdbWriter, FullDisk_ThrowsAnError) {
  const std::vector<std::byte> bytes = test::StockNvdb(GridType::float32).file();
  FaultyFileSystem full(*files_, 1, ENOSPC);  // the call after create
  const auto file = full.create(path_);
  EXPECT_THROW(write_vdb(NvdbGrid::open(bytes, "in.nvdb"), "in.nvdb", {}, *file), Error);
  EXPECT_TRUE(full.failed());
}

}  // namespace
}  // namespace weir::vdb_writer_test
