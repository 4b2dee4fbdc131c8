#include "ingest/vdb/nvdb_source.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>

#include "format/base/little_endian.h"
#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/nvdb_grid.h"
#include "format/nanovdb/nvdb_header.h"
#include "ingest/source_registry.h"
#include "tests/ingest/support/header_file.h"
#include "tests/stock/stock_nvdb.h"

namespace weir::nvdb_source_test {
namespace {

using test::StockNvdb;

/// Returns every voxel of `box` as the stock accessor reads it.
std::vector<float> expected_values(const StockNvdb& stock, const Box& box) {
  std::vector<float> values;
  for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
    for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
      for (std::int64_t x = box.lo.x; x < box.hi.x; ++x) values.push_back(stock.value({x, y, z}));
    }
  }
  return values;
}

TEST(NvdbSource, ReadsEveryTypeAsTheStockAccessorDoes) {
  const Scratch scratch;
  for (const GridType type : {GridType::float32, GridType::fp4, GridType::fp8, GridType::fp16, GridType::fpn}) {
    SCOPED_TRACE(grid_type_name(type));
    const StockNvdb stock(type);
    const std::string path = scratch.write("a.nvdb", stock.file());
    const auto source = open_source(path, {});
    const SourceInfo& info = source->info();
    EXPECT_EQ(info.format, "nanovdb");
    EXPECT_EQ(info.dataset, "sample");
    EXPECT_EQ(info.domain(), stock.index_bbox());
    EXPECT_EQ(info.spacing, (std::array<double, 3>{0.5, 0.5, 0.5}));
    EXPECT_EQ(info.origin, (std::array<double, 3>{10, 20, 30}));
    EXPECT_EQ(info.file_bytes, std::filesystem::file_size(path));
    std::vector<Box> boxes = test::stock_sample_boxes();
    boxes.push_back({{60, 60, 60}, {84, 76, 76}});          // tiles of 8
    boxes.push_back({{250, 120, 0}, {260, 132, 3}});        // tiles of 128
    boxes.push_back({{-8200, 4090, 0}, {-8180, 4100, 2}});  // tiles of 4096
    for (const Box& wanted : boxes) {
      const Box box = intersect(wanted, info.domain());
      std::vector<float> values(static_cast<std::size_t>(box.voxels()));
      source->read(box, values);
      EXPECT_EQ(values, expected_values(stock, box));
    }
  }
}

/// Returns the file of a stock grid with `number` as its class in the head, and with `background`.
std::vector<std::byte> classed(GridType type, std::uint32_t number, float background) {
  auto bytes = StockNvdb(type).file();
  const auto grid = NvdbGrid::open(bytes, "a.nvdb").grid_offset();
  store(bytes, grid + nvdb::grid::kGridClass, number);
  store(bytes, grid + nvdb::kRootOffset + nvdb::root::kBackground, background);
  return bytes;
}

TEST(NvdbSource, ClassAndBackgroundOfALevelSet_AreKept) {
  const Scratch scratch;
  const auto info_of = [&](GridType type, std::uint32_t number, float background = 3.0F) {
    return open_source(scratch.write("a.nvdb", classed(type, number, background)), {})->info();
  };
  for (const GridType type : {GridType::float32, GridType::fp4, GridType::fp8, GridType::fp16, GridType::fpn}) {
    SCOPED_TRACE(grid_type_name(type));
    const SourceInfo level_set = info_of(type, 1);
    EXPECT_EQ(level_set.grid_class, GridClass::level_set);
    EXPECT_EQ(level_set.background, 3.0F);
    const SourceInfo fog = info_of(type, 2);
    EXPECT_EQ(fog.grid_class, GridClass::fog_volume);
    EXPECT_FALSE(fog.background) << "found as of any other volume";
  }
  for (const std::uint32_t number : {0U, 3U, 7U, 0xFFFFFFFFU}) {  // unknown, staggered, voxel volume, no class
    EXPECT_EQ(info_of(GridType::float32, number).grid_class, GridClass::unknown) << number;
    EXPECT_FALSE(info_of(GridType::float32, number).background) << number;
  }
  EXPECT_FALSE(info_of(GridType::float32, 1, std::numeric_limits<float>::infinity()).background);
}

TEST(NvdbSource, ClassIsListed) {
  const Scratch scratch;
  const auto first_attribute = [&](std::uint32_t number) {
    const auto bytes = classed(GridType::float32, number, 3.0F);
    return list_nvdb(scratch.write("a.nvdb", bytes), {}).at(0).attributes.at(0);
  };
  EXPECT_EQ(first_attribute(1), (std::pair<std::string, std::string>{"class", "level set"}));
  EXPECT_EQ(first_attribute(2), (std::pair<std::string, std::string>{"class", "fog volume"}));
  EXPECT_EQ(first_attribute(0), (std::pair<std::string, std::string>{"index origin", "-8192,-5,-20"}));
}

TEST(NvdbSource, ChoosesByName) {
  const Scratch scratch;
  const StockNvdb stock(GridType::float32);
  const std::string path = scratch.write("a.nvdb", stock.file_of_two());
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(path, {}); }),
            path + ": holds 2 grids that can be converted; name a grid with --dataset: 'sample', 'second'");
  SourceOptions options;
  options.dataset = "second";
  const auto second = open_source(path, options);
  EXPECT_EQ(second->info().domain(), (Box{{1, 2, 3}, {2, 3, 4}}));
  EXPECT_EQ(read_volume(*second), std::vector<float>{4});
  options.dataset = "sample";
  EXPECT_EQ(open_source(path, options)->info().domain(), stock.index_bbox());
  options.dataset = "third";
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(path, options); }),
            path + ": has no grid 'third'; it has 'sample', 'second'");
}

TEST(NvdbSource, ReadsSeveralSegmentsAndNumbersEqualNames) {
  const Scratch scratch;
  const StockNvdb stock(GridType::fp8);
  auto bytes = stock.file();
  const auto other = StockNvdb(GridType::fp16).file();
  bytes.insert(bytes.end(), other.begin(), other.end());
  const std::string path = scratch.write("a.nvdb", bytes);
  const auto list = list_nvdb(path, {});
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].name, "sample[0]");
  EXPECT_EQ(list[0].type, "fp8");
  EXPECT_EQ(list[1].name, "sample[1]");
  EXPECT_EQ(list[1].type, "fp16");
  SourceOptions options;
  options.dataset = "sample[1]";
  const auto source = open_source(path, options);
  std::vector<float> value(1);
  source->read({{3, 4, 5}, {4, 5, 6}}, value);
  EXPECT_EQ(value[0], StockNvdb(GridType::fp16).value({3, 4, 5}));
}

TEST(NvdbSource, ListsPlaceAndMemory) {
  const Scratch scratch;
  const StockNvdb stock(GridType::fpn);
  const auto list = list_nvdb(scratch.write("a.nvdb", stock.file()), {});
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].name, "sample");
  EXPECT_EQ(list[0].type, "fpn");
  EXPECT_EQ(list[0].obstacle, "");
  const Index3 extent = stock.index_bbox().extent();
  EXPECT_EQ(list[0].extents, (std::vector<std::int64_t>{extent.x, extent.y, extent.z}));
  EXPECT_EQ(list[0].attributes.at(0).second, "-8192,-5,-20");
  EXPECT_EQ(list[0].attributes.at(1).second, "0.5,0.5,0.5");
  EXPECT_EQ(list[0].attributes.at(2).second, "10,20,30");
}

TEST(NvdbSource, UnreadableFilesAreRefusedWithAReason) {
  const Scratch scratch;
  auto bytes = StockNvdb(GridType::float32).file();
  bytes[14] = std::byte{1};
  std::string path = scratch.write("zip.nvdb", bytes);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(path, {}); }),
            path +
                ": at byte 14: the grid is compressed, codec 1 (zip); write it uncompressed with nanovdb_convert (to "
                ".vdb and back, without --zip and --blosc)");
  EXPECT_EQ(list_nvdb(path, {}).at(0).obstacle.substr(0, 41), "at byte 14: the grid is compressed, codec");
  path = write_headed(scratch, "b.nvdb", "garbage, garbage");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(path, {}); }),
            path + ": at byte 0: magic number 0x2c65676162726167 is not NanoVDB0 or NanoVDB2; not a NanoVDB file");
}

TEST(NvdbSource, HeadThatDoesNotFitItsChecksum_IsSaid) {
  const Scratch scratch;
  const StockNvdb stock(GridType::float32);
  std::vector<std::string> said;
  SourceOptions options;
  options.notice = [&](const Message& line) { said.push_back(line.text()); };
  auto bytes = stock.file();
  open_source(scratch.write("a.nvdb", bytes), options);
  EXPECT_EQ(said, std::vector<std::string>{});
  const NvdbGrid grid = NvdbGrid::open(bytes, "a.nvdb", all_nvdb_segments(bytes, "a.nvdb").at(0));
  bytes[static_cast<std::size_t>(grid.grid_offset()) + nvdb::grid::kName] ^= std::byte{1};
  const std::string path = scratch.write("b.nvdb", bytes);
  options.dataset.clear();
  open_source(path, options);
  ASSERT_EQ(said.size(), 1U);
  EXPECT_TRUE(said[0].starts_with(path + ": grid ")) << said[0];
  EXPECT_TRUE(
      said[0].ends_with(" has another head than its checksum is of: the file may be damaged; weir verify and "
                        "nanovdb_validate say what of it"))
      << said[0];
}

TEST(NvdbSource, MissingIsAnExactValue) {
  const Scratch scratch;
  const StockNvdb stock(GridType::float32);
  const std::string path = scratch.write("a.nvdb", stock.file());
  SourceOptions options;
  options.missing = StoredValue{0.75};  // the value of all voxels of one leaf, except for one voxel that is 11
  const auto source = open_source(path, options);
  std::vector<float> values(512);
  source->read({{96, 8, 8}, {104, 16, 16}}, values);
  EXPECT_EQ(std::count_if(values.begin(), values.end(), is_missing), 511);
  EXPECT_EQ(std::count(values.begin(), values.end(), 11.0F), 1);
}

TEST(NvdbSource, AFileCutAnywhereIsRefused) {
  const Scratch scratch;
  const auto whole = StockNvdb(GridType::fp4).file();
  for (std::size_t size = 1; size < whole.size(); size += size < 2000 ? 1 : whole.size() / 50) {
    const std::string path = scratch.write("cut.nvdb", std::span(whole).first(size));
    EXPECT_FALSE(message_of_error(ErrorKind::input, [&] { open_source(path, {}); }).empty()) << size;
  }
}

}  // namespace
}  // namespace weir::nvdb_source_test
