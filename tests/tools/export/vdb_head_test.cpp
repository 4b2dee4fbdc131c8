// Tests the head of a .vdb file with weir's own reader. vdb_writer_test.cpp tests it with OpenVDB.
#include "tools/export/vdb_head.h"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

#include "ingest/vdb/vdb_header.h"

namespace weir::vdb_head_test {
namespace {

VdbHeader parse(const std::string& bytes) {
  std::istringstream in(bytes);
  const std::string path = "a.vdb";
  VdbReader reader(in, bytes.size(), path);
  return read_vdb_header(reader);
}

VdbHead head() {
  VdbHead head;
  head.creator = "weir";
  head.name = "density";
  head.compression = kVdbZip | kVdbActiveMask;
  head.metadata = {{"class", "level set"}, {"count", std::int64_t{0}}};
  head.matrix = {0.5, 0, 0, 0, 0.25, 0, 0, 0, 2};
  head.translation = {1, 2, 3};
  return head;
}

TEST(VdbHead, WrittenHeadIsReadBackUnchanged) {
  VdbHead written = head();
  written.end = vdb_head_bytes(written).size();
  const std::string bytes = vdb_head_bytes(written);
  const VdbHeader read = parse(bytes);
  EXPECT_EQ(read.version, 224U);
  EXPECT_EQ(read.library_major, 10U);
  ASSERT_EQ(read.grids.size(), 1U);
  const VdbGrid& grid = read.grids[0];
  EXPECT_EQ(grid.name, "density");
  EXPECT_EQ(grid.tree, "Tree_float_5_4_3");
  EXPECT_FALSE(grid.half);
  EXPECT_EQ(grid.parent, "");
  EXPECT_EQ(grid.compression, kVdbZip | kVdbActiveMask);
  EXPECT_EQ(grid.tree_offset, bytes.size());
  EXPECT_EQ(grid.map, "ScaleTranslateMap");
  EXPECT_EQ(grid.steps, (std::array<Vector3, 3>{{{0.5, 0, 0}, {0, 0.25, 0}, {0, 0, 2}}}));
  EXPECT_EQ(grid.first, (Vector3{1, 2, 3}));
  EXPECT_EQ(grid.grid_class, "level set");
}

TEST(VdbHead, HalfFloatsAndRotatedMapsAreReadBack) {
  VdbHead written = head();
  written.half = true;
  written.matrix = {0, -1, 0, 1, 0, 0, 0, 0, 2};
  written.end = vdb_head_bytes(written).size();
  const VdbGrid turned = parse(vdb_head_bytes(written)).grids.at(0);
  EXPECT_TRUE(turned.half);
  EXPECT_EQ(turned.tree, "Tree_float_5_4_3");
  EXPECT_EQ(turned.map, "AffineMap");
  EXPECT_EQ(turned.steps, (std::array<Vector3, 3>{{{0, 1, 0}, {-1, 0, 0}, {0, 0, 2}}}));
  EXPECT_EQ(turned.first, (Vector3{1, 2, 3}));
}

TEST(VdbHead, SizeDoesNotDependOnValuesFilledInLast) {
  const VdbHead empty = head();
  VdbHead full = head();
  full.metadata["count"] = std::numeric_limits<std::int64_t>::max();
  full.leaves_begin = full.end = std::uint64_t{1} << 40U;
  full.content.bytes.fill(std::byte{0xab});
  const std::string bytes = vdb_head_bytes(full);
  EXPECT_EQ(bytes.size(), vdb_head_bytes(empty).size());
  EXPECT_EQ(bytes.substr(21, 36), "abababab-abab-abab-abab-abababababab");
}

TEST(VdbHead, TransformsThatOpenVdbCannotRead) {
  EXPECT_EQ(vdb_transform_obstacle({1e-9, 0, 0, 0, 1e-9, 0, 0, 0, 1e-9}, {0, 0, 0}), "");
  EXPECT_EQ(vdb_transform_obstacle({1, 0, 0, 0, 0, 0, 0, 0, 1}, {0, 0, 0}),
            "its map is not finite or has a voxel size of 0");
  EXPECT_EQ(vdb_transform_obstacle({1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, std::numeric_limits<double>::infinity(), 0}),
            "its map is not finite or has a voxel size of 0");
  EXPECT_EQ(vdb_transform_obstacle({1, 1, 0, 1, 1, 0, 0, 0, 1}, {0, 0, 0}),
            "its rotated map has a determinant of 0, and OpenVDB reads none below 3e-15; give larger voxels or no "
            "rotation");
}

}  // namespace
}  // namespace weir::vdb_head_test
