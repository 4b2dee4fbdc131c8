// Every check of the reader, by the damage that trips it and the message it gives.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/macrocells.h"
#include "format/nanovdb/nvdb_grid.h"
#include "tests/stock/stock_nvdb.h"
#include "tests/support/temporary_directory.h"

namespace weir::nvdb_corruption_test {
namespace {

using Bytes = std::vector<std::byte>;

// The stock sample of a type, once; its grid begins at kGrid (name "sample" and a NUL).
const Bytes& stock(GridType type) {
  static std::map<GridType, Bytes> files;
  auto& file = files[type];
  if (file.empty()) file = test::StockNvdb(type).file();
  return file;
}

constexpr std::uint64_t kGrid = nvdb::kNameOffset + 7;
constexpr std::uint64_t kTree = kGrid + nvdb::kTreeOffset;
constexpr std::uint64_t kRoot = kGrid + nvdb::kRootOffset;
constexpr std::uint64_t kTiles = kGrid + nvdb::kRootTilesOffset;

template <typename T>
void put(Bytes& file, std::uint64_t offset, T value) {
  std::memcpy(file.data() + offset, &value, sizeof value);
}

template <typename T>
T get(const Bytes& file, std::uint64_t offset) {
  T value;
  std::memcpy(&value, file.data() + offset, sizeof value);
  return value;
}

std::string message_of(const Bytes& file) {
  try {
    NvdbGrid::open(file, "a.nvdb");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "no error";
}

std::string message(GridType type, const std::function<void(Bytes&)>& damage) {
  Bytes file = stock(type);
  damage(file);
  return message_of(file);
}

std::string message(const std::function<void(Bytes&)>& damage) { return message(GridType::float32, damage); }

// File offset of the first node of a level: 0 leaf, 1 lower, 2 upper.
std::uint64_t first_node(const Bytes& file, unsigned level) {
  return kTree + get<std::uint64_t>(file, kTree + 8 * level);
}

// Number of the first child entry of an internal node.
unsigned first_child(const Bytes& file, std::uint64_t node, const nvdb::InternalLayout& layout) {
  for (unsigned n = 0;; ++n) {
    if ((static_cast<unsigned>(file[node + layout.child_mask + n / 8]) >> (n % 8) & 1U) != 0) return n;
  }
}

TEST(NvdbCorruption, FileHeader) {
  EXPECT_EQ(message([](Bytes& f) { f.clear(); }),
            "a.nvdb: at byte 0: the file ends after 0 bytes, inside the NanoVDB header of 16 bytes; is it complete?");
  EXPECT_EQ(message([](Bytes& f) { f.resize(15); }),
            "a.nvdb: at byte 15: the file ends after 15 bytes, inside the NanoVDB header of 16 bytes; is it complete?");
  EXPECT_EQ(message([](Bytes& f) { put<std::uint64_t>(f, 0, 0x89504e47); }),
            "a.nvdb: at byte 0: magic number 0x89504e47 is not NanoVDB0 or NanoVDB2; not a NanoVDB file");
  EXPECT_EQ(message([](Bytes& f) { f[7] = std::byte{'1'}; }),
            "a.nvdb: at byte 0: a raw grid without file header (magic NanoVDB1); write it with nanovdb::io::writeGrid");
  EXPECT_EQ(message([](Bytes& f) { f[7] = std::byte{'2'}; }), "no error");
  EXPECT_EQ(
      message([](Bytes& f) { put<std::uint32_t>(f, 8, 31U << 21U | 5U << 10U | 7U); }),
      "a.nvdb: at byte 8: NanoVDB version 31.5.7 but only major version 32 can be read; write the file again with "
      "a current NanoVDB");
  EXPECT_EQ(message([](Bytes& f) { put<std::uint32_t>(f, 8, 33U << 21U | 1U << 10U); }),
            "a.nvdb: at byte 8: NanoVDB version 33.1.0 but only major version 32 can be read; read it with a newer "
            "weir, or write it with NanoVDB 32.x");
  EXPECT_EQ(message([](Bytes& f) { put<std::uint16_t>(f, 12, 0); }), "a.nvdb: at byte 12: the file holds 0 grids");
  const std::string remedy =
      "; write it uncompressed with nanovdb_convert (to .vdb and back, without --zip and --blosc)";
  EXPECT_EQ(message([](Bytes& f) { put<std::uint16_t>(f, 14, 2); }),
            "a.nvdb: at byte 14: the grid is compressed, codec 2 (blosc)" + remedy);
  EXPECT_EQ(message([](Bytes& f) { put<std::uint16_t>(f, nvdb::meta::kCodec, 1); }),
            "a.nvdb: at byte 184: the grid is compressed, codec 1 (zip)" + remedy);
}

TEST(NvdbCorruption, MetaData) {
  EXPECT_EQ(message([](Bytes& f) { f.resize(100); }),
            "a.nvdb: at byte 100: the file ends inside the meta data of grid 0 of 1; is it complete?");
  EXPECT_EQ(message([](Bytes& f) { put<std::uint16_t>(f, 12, 65535); }).substr(0, 10), "a.nvdb: at");
  const std::string size = std::to_string(stock(GridType::float32).size());
  EXPECT_EQ(
      message([](Bytes& f) { put<std::uint32_t>(f, nvdb::meta::kNameSize, 0xffffffff); }),
      "a.nvdb: at byte 152: a grid name of 4294967295 bytes reaches beyond the file's " + size + "; is it complete?");
  EXPECT_EQ(message([](Bytes& f) { put<std::uint64_t>(f, nvdb::meta::kGridSize, 799); }),
            "a.nvdb: at byte 16: a grid of 799 bytes, smaller than its fixed head of 800");
  const std::string grid_bytes = std::to_string(stock(GridType::float32).size() - kGrid);
  EXPECT_EQ(message([](Bytes& f) { put<std::uint64_t>(f, nvdb::meta::kFileSize, 1234); }),
            "a.nvdb: at byte 24: an uncompressed grid of " + grid_bytes + " bytes stored in 1234");
  EXPECT_EQ(message([](Bytes& f) { f.pop_back(); }),
            "a.nvdb: at byte 16: a grid of " + grid_bytes + " bytes at byte 199 reaches beyond the file's " +
                std::to_string(stock(GridType::float32).size() - 1) + "; is it complete?");
  EXPECT_EQ(message([](Bytes& f) {
              put<std::uint64_t>(f, nvdb::meta::kGridSize, ~std::uint64_t{0});
              put<std::uint64_t>(f, nvdb::meta::kFileSize, ~std::uint64_t{0});
            }),
            "a.nvdb: at byte 16: a grid of 18446744073709551615 bytes at byte 199 reaches beyond the file's " + size +
                "; is it complete?");
  EXPECT_EQ(message([](Bytes& f) { put<std::uint32_t>(f, nvdb::meta::kGridType, 16); }),
            "a.nvdb: at byte 48: the meta data says grid type 16 (FpN), the grid 1 (float)");
}

TEST(NvdbCorruption, GridHead) {
  EXPECT_EQ(message([](Bytes& f) { put<std::uint64_t>(f, kGrid, 7); }),
            "a.nvdb: at byte 199: grid magic number 0x7 is not NanoVDB0 or NanoVDB1");
  EXPECT_EQ(message([](Bytes& f) { f[kGrid + 7] = std::byte{'1'}; }), "no error");
  EXPECT_EQ(message([](Bytes& f) { put<std::uint32_t>(f, kGrid + nvdb::grid::kVersion, 33U << 21U); }),
            "a.nvdb: at byte 215: NanoVDB version 33.0.0 but only major version 32 can be read; read it with a newer "
            "weir, or write it with NanoVDB 32.x");
  const std::string bytes = std::to_string(stock(GridType::float32).size() - kGrid);
  EXPECT_EQ(message([](Bytes& f) { put<std::uint64_t>(f, kGrid + nvdb::grid::kGridSize, 5); }),
            "a.nvdb: at byte 231: the grid says 5 bytes, the file's meta data " + bytes);
  for (const auto& [type, text] : {std::pair{0U, "0 (unknown)"}, std::pair{2U, "2 (double)"},
                                   std::pair{12U, "12 (RGBA8)"}, std::pair{17U, "17 (Vec4f)"}, std::pair{99U, "99"}}) {
    EXPECT_EQ(message([t = type](Bytes& f) { put<std::uint32_t>(f, kGrid + nvdb::grid::kGridType, t); }),
              std::string("a.nvdb: at byte 835: grid type ") + text +
                  " is not supported; use a float, Fp4, Fp8, Fp16 or FpN grid");
  }
  EXPECT_EQ(message([](Bytes& f) { put(f, kGrid + nvdb::grid::kVoxelSize + 8, -0.5); }),
            "a.nvdb: at byte 815: voxel size -0.5 is not positive and finite");
  EXPECT_EQ(message([](Bytes& f) { put(f, kGrid + nvdb::grid::kVoxelSize, std::numeric_limits<double>::quiet_NaN()); }),
            "a.nvdb: at byte 807: voxel size nan is not positive and finite");
  EXPECT_EQ(message([](Bytes& f) { put(f, kGrid + 528, std::numeric_limits<double>::infinity()); }),
            "a.nvdb: at byte 727: world origin inf is not finite");
}

TEST(NvdbCorruption, TreeOffsets) {
  const std::string bytes = std::to_string(stock(GridType::float32).size() - kGrid);
  EXPECT_EQ(message([](Bytes& f) { put<std::uint64_t>(f, kTree + nvdb::tree::kRootOffset, 96); }),
            "a.nvdb: at byte 895: root offset 96 instead of 64");
  EXPECT_EQ(message([](Bytes& f) { put<std::uint32_t>(f, kRoot + nvdb::root::kTableSize, 0xffffffff); }),
            "a.nvdb: at byte 959: a root table of 4294967295 entries reaches beyond the grid's " + bytes + " bytes");
  const auto misplaced = [&](unsigned level, const char* name, std::uint64_t offset) {
    EXPECT_EQ(message([&](Bytes& f) { put<std::uint64_t>(f, kTree + 8 * level, offset); }),
              "a.nvdb: at byte " + std::to_string(kTree + 8 * level) + ": first " + name + " node at offset " +
                  std::to_string(offset) + ", not a multiple of 32 behind the level above and inside the grid's " +
                  bytes + " bytes");
  };
  misplaced(2, "upper", 0);
  misplaced(2, "upper", 128 + 15 * 32 - 32);
  misplaced(2, "upper", 128 + 15 * 32 + 8);
  misplaced(2, "upper", ~std::uint64_t{0} - 671);
  misplaced(2, "upper", std::uint64_t{1} << 40U);
  misplaced(1, "lower", 128 + 15 * 32);
  misplaced(0, "leaf", 128 + 15 * 32);
  EXPECT_EQ(message([](Bytes& f) { put<std::uint32_t>(f, kTree + nvdb::tree::kNodeCount, 0xffffffff); }),
            "a.nvdb: at byte 871: 4294967295 leaf nodes at offset " +
                std::to_string(get<std::uint64_t>(stock(GridType::float32), kTree)) + " reach beyond the grid's " +
                bytes + " bytes");
}

TEST(NvdbCorruption, RootTable) {
  EXPECT_EQ(message([](Bytes& f) { put<std::uint64_t>(f, kTiles, std::uint64_t{1} << 63U); }),
            "a.nvdb: at byte 999: root tile key 0x8000000000000000 is no key of 32-bit coordinates");
  EXPECT_EQ(message([](Bytes& f) { put(f, kTiles + 8, std::numeric_limits<std::int64_t>::max()); }),
            "a.nvdb: at byte 1007: child offset 9223372036854775807 leaves the grid");
  EXPECT_EQ(message([](Bytes& f) { put<std::int64_t>(f, kTiles + 8, -737); }),
            "a.nvdb: at byte 1007: child offset -737 leaves the grid");
  const std::uint64_t upper = first_node(stock(GridType::float32), 2) - kGrid;
  EXPECT_EQ(message([](Bytes& f) { put<std::int64_t>(f, kTiles + 8, 64); }),
            "a.nvdb: at byte 1007: a child at grid offset 800 is none of the 14 upper nodes from grid offset " +
                std::to_string(upper));
  // A value tile has offset 0: the second of two tiles to the same node is the next child.
  std::uint64_t second = kTiles + 32;
  while (get<std::int64_t>(stock(GridType::float32), second + 8) == 0) second += 32;
  EXPECT_EQ(message([&](Bytes& f) { put(f, second + 8, get<std::int64_t>(f, kTiles + 8)); }),
            "a.nvdb: at byte " + std::to_string(second + 8) + ": upper node 0 at grid offset " + std::to_string(upper) +
                " has two parents");
  EXPECT_EQ(message([&](Bytes& f) { put<std::int64_t>(f, kTiles + 8, 0); }),
            "a.nvdb: at byte " + std::to_string(kGrid + upper) + ": upper node 0 of 14 has no parent");
  const auto without_nodes = [](Bytes& f) {
    for (unsigned level = 0; level < 3; ++level) put<std::uint32_t>(f, kTree + nvdb::tree::kNodeCount + 4 * level, 0);
  };
  EXPECT_NE(message(without_nodes).find(" is none of the 0 upper nodes from grid offset "), std::string::npos)
      << message(without_nodes);
  Bytes twice = stock(GridType::float32);
  put(twice, kTiles + 32, get<std::uint64_t>(twice, kTiles));
  EXPECT_NE(message_of(twice).find(" stands in the table twice"), std::string::npos) << message_of(twice);
}

TEST(NvdbCorruption, InternalNodes) {
  const Bytes& file = stock(GridType::float32);
  const std::uint64_t upper = first_node(file, 2);
  const std::uint64_t lower = first_node(file, 1);
  const std::uint64_t leaf = first_node(file, 0);
  const unsigned u = first_child(file, upper, nvdb::kUpper);
  const unsigned l = first_child(file, lower, nvdb::kLower);
  const std::uint64_t upper_entry = upper + nvdb::kUpper.table + 8 * u;
  const std::uint64_t lower_entry = lower + nvdb::kLower.table + 8 * l;
  const auto at = [](std::uint64_t offset) { return "a.nvdb: at byte " + std::to_string(offset) + ": "; };
  const std::string uppers_lowers = std::to_string(get<std::uint32_t>(file, kTree + 36));
  const std::string leaves = std::to_string(get<std::uint32_t>(file, kTree + 32));

  EXPECT_EQ(
      message([&](Bytes& f) { f[upper + nvdb::kUpper.value_mask + u / 8] |= std::byte(1U << (u % 8)); }),
      at(upper + nvdb::kUpper.child_mask + u / 64 * 8) + "entry " + std::to_string(u) + " is both a value and a child");
  EXPECT_EQ(
      message([&](Bytes& f) { f[lower + nvdb::kLower.value_mask + l / 8] |= std::byte(1U << (l % 8)); }),
      at(lower + nvdb::kLower.child_mask + l / 64 * 8) + "entry " + std::to_string(l) + " is both a value and a child");
  // An upper node as its own child, a lower node that points back up, and wild offsets.
  EXPECT_EQ(message([&](Bytes& f) { put<std::int64_t>(f, upper_entry, 0); }),
            at(upper_entry) + "a child at grid offset " + std::to_string(upper - kGrid) + " is none of the " +
                uppers_lowers + " lower nodes from grid offset " + std::to_string(lower - kGrid));
  EXPECT_EQ(message([&](Bytes& f) { put<std::int64_t>(f, upper_entry, std::numeric_limits<std::int64_t>::min()); }),
            at(upper_entry) + "child offset -9223372036854775808 leaves the grid");
  EXPECT_EQ(message([&](Bytes& f) { put(f, lower_entry, static_cast<std::int64_t>(upper - lower)); }),
            at(lower_entry) + "a child at grid offset " + std::to_string(upper - kGrid) + " is none of the " + leaves +
                " leaf nodes from grid offset " + std::to_string(leaf - kGrid));
  EXPECT_EQ(message([&](Bytes& f) { put(f, lower_entry, static_cast<std::int64_t>(f.size() - lower)); }),
            at(lower_entry) + "a child at grid offset " + std::to_string(file.size() - kGrid) + " is none of the " +
                leaves + " leaf nodes from grid offset " + std::to_string(leaf - kGrid));
  EXPECT_EQ(message([&](Bytes& f) { put(f, lower_entry, get<std::int64_t>(f, lower_entry) + 32); }),
            at(lower_entry) + "a child at grid offset " + std::to_string(leaf - kGrid + 32) + " is none of the " +
                leaves + " leaf nodes from grid offset " + std::to_string(leaf - kGrid));
  EXPECT_EQ(message([&](Bytes& f) { f[lower + nvdb::kLower.child_mask + l / 8] &= ~std::byte(1U << (l % 8)); }),
            at(kTree + 32) + leaves + " leaves, but the lower nodes have " + std::to_string(std::stoul(leaves) - 1));
}

TEST(NvdbCorruption, BoundingBox) {
  const std::string outside = "lies outside the 15 root tiles or has 2^62 voxels or more";
  EXPECT_EQ(message([](Bytes& f) { put<std::int32_t>(f, kRoot, -12288); }),
            "a.nvdb: at byte 935: bounding box [-12288,-5,-20] .. [4103,8192,4096) " + outside);
  EXPECT_EQ(message([](Bytes& f) {
              for (unsigned i = 0; i < 3; ++i) {
                put(f, kRoot + 4 * i, std::numeric_limits<std::int32_t>::min());
                put(f, kRoot + 12 + 4 * i, std::numeric_limits<std::int32_t>::max());
              }
            }),
            "a.nvdb: at byte 935: bounding box [-2147483648,-2147483648,-2147483648] .. "
            "[2147483648,2147483648,2147483648) " +
                outside);
  Bytes empty = stock(GridType::float32);
  put<std::int32_t>(empty, kRoot, std::numeric_limits<std::int32_t>::max());
  put<std::int32_t>(empty, kRoot + 12, std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(NvdbGrid::open(empty, "a.nvdb").index_bbox(), Box{});
}

TEST(NvdbCorruption, FpnLeaves) {
  const Bytes& file = stock(GridType::fpn);
  std::uint64_t last = 0;
  NvdbGrid::open(file, "a.nvdb").for_each_block([&](const GridBlock& block) {
    if (block.leaf != nullptr) last = std::max(last, static_cast<std::uint64_t>(block.leaf - file.data()));
  });
  const auto set_width = [](Bytes& f, std::uint64_t leaf, unsigned log2) {
    f[leaf + nvdb::leaf::kFlags] = (f[leaf + nvdb::leaf::kFlags] & std::byte{31}) | std::byte(log2 << 5U);
  };
  EXPECT_EQ(message(GridType::fpn, [&](Bytes& f) { set_width(f, last, 7); }),
            "a.nvdb: at byte " + std::to_string(last + 15) + ": log2 of the FpN leaf's width is 7, at most 4");
  EXPECT_EQ(message(GridType::fpn,
                    [&](Bytes& f) {
                      const std::uint64_t cut = last + 160 - kGrid;  // the last leaf no longer fits
                      f.resize(last + 160);
                      set_width(f, last, 4);
                      put(f, nvdb::meta::kGridSize, cut);
                      put(f, nvdb::meta::kFileSize, cut);
                      put(f, kGrid + nvdb::grid::kGridSize, cut);
                    }),
            "a.nvdb: at byte " + std::to_string(last) + ": an FpN leaf of 1120 bytes reaches beyond the grid's " +
                std::to_string(last + 160 - kGrid) + " bytes");

  // Open does not read the widths of leaves that lie well before the end; decoding does.
  Bytes bad = file;
  const std::uint64_t first = first_node(bad, 0);
  set_width(bad, first, 5);
  const NvdbGrid grid = NvdbGrid::open(bad, "a.nvdb");
  std::vector<float> values(512);
  const std::string expected =
      "a.nvdb: at byte " + std::to_string(first + 15) + ": log2 of the FpN leaf's width is 5, at most 4";
  const auto thrown = [](const std::function<void()>& call) -> std::string {
    try {
      call();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(thrown([&] { grid.decode_leaf(bad.data() + first, std::span<float, 512>(values)); }), expected);
  EXPECT_EQ(thrown([&] { grid.for_each_block([&](const GridBlock& block) { grid.value(block.origin); }); }), expected);
}

// The float sample with one blind record appended and its data behind.
Bytes with_blind(const std::string& name, std::uint32_t type, std::uint64_t count, const std::vector<float>& data) {
  Bytes file = stock(GridType::float32);
  const std::uint64_t record = file.size();
  file.resize(record + nvdb::kBlindMetaBytes + 4 * data.size());
  put<std::int64_t>(file, record + nvdb::blind::kDataOffset, static_cast<std::int64_t>(nvdb::kBlindMetaBytes));
  put(file, record + nvdb::blind::kCount, count);
  put<std::uint32_t>(file, record + nvdb::blind::kElementSize, 4);
  put(file, record + nvdb::blind::kType, type);
  std::memcpy(file.data() + record + nvdb::blind::kName, name.data(), name.size());
  std::memcpy(file.data() + record + nvdb::kBlindMetaBytes, data.data(), 4 * data.size());
  put(file, kGrid + nvdb::grid::kBlindOffset, record - kGrid);
  put<std::uint32_t>(file, kGrid + nvdb::grid::kBlindCount, 1);
  for (const std::uint64_t field : {nvdb::meta::kGridSize, nvdb::meta::kFileSize, kGrid + nvdb::grid::kGridSize}) {
    put(file, field, file.size() - kGrid);
  }
  return file;
}

TEST(NvdbCorruption, BlindData) {
  const std::uint64_t record = stock(GridType::float32).size();
  const auto at = [&](std::uint64_t field) { return "a.nvdb: at byte " + std::to_string(record + field) + ": "; };
  const Bytes good = with_blind("other", 1, 4, {1, 2, 3, 4});
  EXPECT_EQ(message_of(good), "no error");
  EXPECT_EQ(NvdbGrid::open(good, "a.nvdb").data_bytes(), good.size() - kGrid);
  const std::string bytes = std::to_string(good.size() - kGrid);

  EXPECT_EQ(message_of(with_blind("other", 1, 5, {1, 2, 3, 4})),
            at(8) + "5 elements of 4 bytes of blind data at grid offset " + std::to_string(record + 288 - kGrid) +
                " reach beyond the grid's " + bytes + " bytes");
  EXPECT_EQ(message_of(with_blind("other", 1, ~std::uint64_t{0} / 4 + 2, {1, 2, 3, 4})).substr(0, 20),
            at(8).substr(0, 20));
  Bytes far = good;
  put<std::int64_t>(far, record, std::int64_t{1} << 40U);
  EXPECT_EQ(message_of(far), at(0) + "blind data offset 1099511627776 leaves the grid's " + bytes + " bytes");
  put<std::int64_t>(far, record, std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(message_of(far), at(0) + "blind data offset -9223372036854775808 leaves the grid's " + bytes + " bytes");
  Bytes many = good;
  put<std::uint32_t>(many, kGrid + nvdb::grid::kBlindCount, 2);
  EXPECT_EQ(message_of(many), "a.nvdb: at byte 839: 2 blind data records at grid offset " +
                                  std::to_string(record - kGrid) + ", not between the last node at " +
                                  std::to_string(record - kGrid) + " and the grid's end at " + bytes);
  Bytes overlap = good;
  put<std::uint64_t>(overlap, kGrid + nvdb::grid::kBlindOffset, record - kGrid - 32);
  EXPECT_EQ(message_of(overlap).substr(0, 30), "a.nvdb: at byte 839: 1 blind d");

  // Elements of unknown size: everything up to the grid's end may belong to them.
  Bytes unknown = with_blind("name", 0, 3, {1, 2, 3, 4});
  EXPECT_EQ(NvdbGrid::open(unknown, "a.nvdb").data_bytes(), unknown.size() - kGrid);
}

TEST(NvdbCorruption, Macrocells) {
  const std::uint64_t record = stock(GridType::float32).size();
  // The sample's box is [-8192, 4103) x [-5, 8192) x [-20, 4096): 4 x 3 x 2 cells of 4096^3.
  const std::string name = macrocell_name({4096, 1});
  const Bytes good = with_blind(name, 1, 48, std::vector<float>(48, 2.0F));
  // The record of this file is not aligned to 4 bytes in the file; move it in memory.
  Bytes moved(good.size() + 1);
  std::memcpy(moved.data() + 1, good.data(), good.size());
  const NvdbGrid grid = NvdbGrid::open(std::span(moved).subspan(1), "a.nvdb");
  EXPECT_EQ(grid.macrocells().cell, 4096);
  EXPECT_EQ(grid.macrocells().apron, 1);
  EXPECT_EQ(grid.macrocells().lattice.count, (Index3{4, 3, 2}));
  EXPECT_EQ(grid.macrocells().cells.size(), 24U);
  EXPECT_EQ(grid.macrocells().cells[23].max, 2.0F);
  EXPECT_TRUE(NvdbGrid::open(good, "a.nvdb").macrocells().cells.empty());

  EXPECT_EQ(message_of(with_blind(name, 1, 46, std::vector<float>(48))),
            "a.nvdb: at byte " + std::to_string(record + 8) +
                ": 46 values of macrocells, but 4 x 3 x 2 cells of 4096^3 voxels have 48");
  EXPECT_EQ(message_of(with_blind(name, 10, 48, std::vector<float>(48))),
            "a.nvdb: at byte " + std::to_string(record + 28) + ": macrocells of type 10 instead of float");
  Bytes empty = good;
  put<std::int32_t>(empty, kRoot, std::numeric_limits<std::int32_t>::max());
  EXPECT_EQ(message_of(empty),
            "a.nvdb: at byte " + std::to_string(record) + ": macrocells of a grid without active voxels");
}

}  // namespace
}  // namespace weir::nvdb_corruption_test
