#include "format/nanovdb/grid_head.h"

#include <gtest/gtest.h>
#include <nanovdb/util/IO.h>

#include <cmath>
#include <cstring>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "format/base/little_endian.h"

namespace weir::grid_head_test {
namespace {

GridHead sample_head() {
  GridHead head;
  head.name = "density";
  head.voxel_size = {0.1, 0.25, 3};
  head.origin = {0.3, -7, 1e6};
  head.background = -2.5F;
  head.statistics.add_tile(4, 512, {{-8, 16, 0}, {0, 24, 8}});
  head.statistics.add_tile(1, 512, {{40, 16, 0}, {48, 24, 8}});
  head.active_tiles = {2, 0, 0};
  head.tiles = {{{-4096, 0, 0}, 4096 + 800 + 2 * 32, false, 0}, {{0, 0, 0}, 0, true, 6.5F}};
  return head;
}

TreeLayout sample_layout() { return padded_to(make_layout({2, 1, 1, 3, 3 * 2144, 8}), 600'001); }

TEST(GridHead, NanoVdbReadsEveryGridField) {
  const TreeLayout layout = sample_layout();
  std::vector<std::byte> file = encode_head(sample_head(), layout);
  ASSERT_EQ(file.size(), layout.uppers);
  struct alignas(32) Block {
    std::byte bytes[32];
  };
  std::vector<Block> copy((file.size() - layout.grid) / 32);
  std::memcpy(copy.data(), file.data() + layout.grid, file.size() - layout.grid);
  const auto& grid = *reinterpret_cast<const nanovdb::NanoGrid<float>*>(copy.data());
  EXPECT_STREQ(grid.gridName(), "density");
  EXPECT_EQ(grid.gridSize(), 600'001U - 4096);
  EXPECT_EQ(grid.gridType(), nanovdb::GridType::Float);
  EXPECT_EQ(grid.gridClass(), nanovdb::GridClass::Unknown);
  EXPECT_EQ(grid.version(), nanovdb::Version(32, 4, 2));
  EXPECT_EQ(grid.blindDataCount(), 1);
  EXPECT_TRUE(grid.hasBBox() && grid.hasMinMax() && grid.hasAverage() && grid.hasStdDeviation());
  EXPECT_TRUE(grid.isBreadthFirst());
  EXPECT_EQ(grid.activeVoxelCount(), 1024U);
  EXPECT_EQ(grid.voxelSize(), nanovdb::Vec3R(0.1, 0.25, 3));
  EXPECT_EQ(grid.map().applyMap(nanovdb::Vec3d(0, 0, 0)), nanovdb::Vec3d(0.3, -7, 1e6));
  const nanovdb::Vec3d world = grid.map().applyMap(nanovdb::Vec3d(7, 9, -11));
  EXPECT_EQ(world, nanovdb::Vec3d(std::fma(7, 0.1, 0.3), 9 * 0.25 - 7, 1e6 - 33));
  const nanovdb::Vec3d back = grid.map().applyInverseMap(world);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(back[i], (i == 0 ? 7.0 : i == 1 ? 9.0 : -11.0), 1e-9);
  EXPECT_EQ(grid.worldBBox().min(), grid.map().applyMap(nanovdb::Vec3d(-8, 16, 0)));
  EXPECT_EQ(grid.worldBBox().max(), grid.map().applyMap(nanovdb::Vec3d(48, 24, 8)));
  const auto& tree = grid.tree();
  EXPECT_EQ(tree.nodeCount(0), 3U);
  EXPECT_EQ(tree.nodeCount(1), 1U);
  EXPECT_EQ(tree.nodeCount(2), 1U);
  EXPECT_EQ(tree.activeTileCount(1), 2U);
  EXPECT_EQ(tree.background(), -2.5F);
  const auto& root = tree.root();
  EXPECT_EQ(root.tileCount(), 2U);
  EXPECT_EQ(root.bbox(), nanovdb::CoordBBox(nanovdb::Coord(-8, 16, 0), nanovdb::Coord(47, 23, 7)));
  EXPECT_EQ(root.minimum(), 1);
  EXPECT_EQ(root.maximum(), 4);
  EXPECT_EQ(root.average(), 2.5F);
  EXPECT_EQ(root.stdDeviation(), 1.5F);
  EXPECT_EQ(tree.getValue(nanovdb::Coord(4095, 0, 4095)), 6.5F);
  EXPECT_TRUE(tree.isActive(nanovdb::Coord(4095, 0, 4095)));
  EXPECT_EQ(tree.getValue(nanovdb::Coord(4096, 0, 0)), -2.5F);
  const auto& tile = *root.data()->tile(0);
  EXPECT_TRUE(tile.isChild());
  EXPECT_EQ(tile.origin(), nanovdb::Coord(-4096, 0, 0));
  EXPECT_EQ(tile.child, 64 + 2 * 32);
  EXPECT_EQ(tree.getFirstNode<0>(), reinterpret_cast<const nanovdb::NanoLeaf<float>*>(
                                        reinterpret_cast<const std::byte*>(copy.data()) + layout.leaves - layout.grid));
}

TEST(GridHead, FileMetaDataMatchesTheGrid) {
  const TreeLayout layout = sample_layout();
  const std::vector<std::byte> file = encode_head(sample_head(), layout);
  nanovdb::io::Segment segment;
  std::istringstream in(std::string(reinterpret_cast<const char*>(file.data()), file.size()));
  ASSERT_TRUE(segment.read(in));
  EXPECT_EQ(static_cast<std::uint64_t>(in.tellg()), layout.grid);
  ASSERT_EQ(segment.meta.size(), 1U);
  const auto& meta = segment.meta[0];
  EXPECT_EQ(meta.gridName, std::string("density"));
  EXPECT_EQ(meta.nameKey, nanovdb::io::stringHash("density"));
  EXPECT_EQ(meta.gridSize, layout.grid_bytes());
  EXPECT_EQ(meta.fileSize, layout.grid_bytes());
  EXPECT_EQ(meta.voxelCount, 1024U);
  EXPECT_EQ(meta.gridType, nanovdb::GridType::Float);
  EXPECT_EQ(meta.indexBBox, nanovdb::CoordBBox(nanovdb::Coord(-8, 16, 0), nanovdb::Coord(47, 23, 7)));
  EXPECT_EQ(meta.worldBBox.min()[0], std::fma(-8, 0.1, 0.3));
  EXPECT_EQ(meta.voxelSize, nanovdb::Vec3R(0.1, 0.25, 3));
  EXPECT_EQ(meta.nodeCount[0], 3U);
  EXPECT_EQ(meta.nodeCount[3], 1U);
  EXPECT_EQ(meta.tileCount[0], 2U);
  EXPECT_EQ(meta.codec, nanovdb::io::Codec::NONE);
}

TEST(GridHead, ClassIsInGridAndMetaData) {
  EXPECT_EQ(static_cast<std::uint32_t>(GridClass::level_set), static_cast<std::uint32_t>(nanovdb::GridClass::LevelSet));
  EXPECT_EQ(static_cast<std::uint32_t>(GridClass::fog_volume),
            static_cast<std::uint32_t>(nanovdb::GridClass::FogVolume));
  for (const GridClass grid_class : {GridClass::unknown, GridClass::level_set, GridClass::fog_volume}) {
    GridHead head = sample_head();
    head.grid_class = grid_class;
    const TreeLayout layout = sample_layout();
    const std::vector<std::byte> file = encode_head(head, layout);
    const auto stored = static_cast<std::uint32_t>(grid_class);
    EXPECT_EQ(load<std::uint32_t>(file, nvdb::meta::kGridClass), stored);
    EXPECT_EQ(load<std::uint32_t>(file, layout.grid + nvdb::grid::kGridClass), stored);
  }
}

TEST(GridHead, NameHashMatchesNanoVdb) {
  for (const std::string& name : {std::string("a"), std::string("/fields/density"), std::string(255, 'z'),
                                  std::string("gr\xC3\xB6\xC3\x9F"
                                              "e"),
                                  std::string(100, '\xFF')}) {
    GridHead head = sample_head();
    head.name = name;
    const std::vector<std::byte> file = encode_head(head, sample_layout());
    EXPECT_EQ(load<std::uint64_t>(file, nvdb::meta::kNameKey), nanovdb::io::stringHash(name.c_str()));
    EXPECT_STREQ(reinterpret_cast<const char*>(file.data()) + nvdb::kNameOffset, name.c_str());
  }
}

TEST(GridHead, NamesOfOneTo255Bytes) {
  for (const std::size_t length : {std::size_t{0}, std::size_t{256}, std::size_t{5000}}) {
    GridHead head = sample_head();
    head.name = std::string(length, 'n');
    try {
      encode_head(head, sample_layout());
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()), "grid name of " + std::to_string(length) + " bytes; use 1 to 255");
    }
  }
}

TEST(GridHead, HeadChecksumIsCrc32) {
  std::vector<std::byte> file = encode_head(sample_head(), sample_layout());
  const std::span grid = std::span(file).subspan(4096);
  const auto stored = load<std::uint32_t>(grid, nvdb::grid::kChecksum);
  EXPECT_EQ(load<std::uint32_t>(grid, nvdb::grid::kChecksum + 4), 0xFFFFFFFFU);
  EXPECT_EQ(stored, head_checksum(grid));
  // CRC-32 by its definition, a bit at a time.
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::byte b : grid.subspan(16)) {
    crc ^= static_cast<std::uint32_t>(b);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  EXPECT_EQ(stored, ~crc);
}

TEST(GridHead, MacrocellRecordDescribesTheData) {
  const TreeLayout layout = sample_layout();
  const std::vector<std::byte> record = encode_blind_records(layout);
  ASSERT_EQ(record.size(), sizeof(nanovdb::GridBlindMetaData));
  nanovdb::GridBlindMetaData meta;
  std::memcpy(static_cast<void*>(&meta), record.data(), sizeof meta);
  EXPECT_EQ(meta.mByteOffset, 288);
  EXPECT_EQ(meta.mElementCount, 16U);
  EXPECT_EQ(meta.mDataType, nanovdb::GridType::Float);
  EXPECT_STREQ(meta.mName, "weir_macrocells:16:1");
}

}  // namespace
}  // namespace weir::grid_head_test
