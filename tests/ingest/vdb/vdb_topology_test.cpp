#include "ingest/vdb/vdb_topology.h"

#include <fstream>

#include "ingest/vdb/openvdb_library.h"
#include "tests/ingest/support/header_file.h"
#include "tests/stock/openvdb_file.h"

namespace weir::vdb_topology_test {
namespace {

using test::Compression;
using test::GridKind;
using test::OpenVdbGrid;

/// Writes `grid` with OpenVDB, lets `change` edit the file's bytes, and returns what a walk of its first tree finds.
template <typename Change>
VdbTopology walk(const OpenVdbGrid& grid, Compression compression, const Change& change) {
  const Scratch scratch;
  test::write_vdb(scratch.path("a.vdb"), {grid}, compression);
  std::ifstream in(scratch.path("a.vdb"), std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  std::istringstream first(bytes);
  const std::string path = "a.vdb";
  VdbReader head(first, bytes.size(), path);
  change(bytes, read_vdb_header(head).grids.at(0).tree_offset);
  std::istringstream second(bytes);
  VdbReader reader(second, bytes.size(), path);
  const VdbHeader header = read_vdb_header(reader);
  return walk_vdb_tree(reader, header.grids.at(0), *vdb_type(header.grids.at(0).tree));
}

VdbTopology walk(const OpenVdbGrid& grid, Compression compression = Compression::active_mask) {
  return walk(grid, compression, [](std::string&, std::uint64_t) {});
}

OpenVdbGrid one_leaf() {
  OpenVdbGrid grid(GridKind::float32, "a");
  return grid.fill({{1, 2, 3}, {3, 4, 5}});
}

template <typename T>
void put(std::string& bytes, std::uint64_t at, T value) {
  bytes.replace(at, sizeof value, reinterpret_cast<const char*>(&value), sizeof value);
}

// Offsets from the tree's beginning. Its fields, in bytes: buffer count 4, background 4, tiles 4, children 4, origin
// 12, then the upper node's two masks of 4096 each, and its values.
constexpr std::uint64_t kBufferCount = 0;
constexpr std::uint64_t kChildren = 12;
constexpr std::uint64_t kOrigin = 16;
constexpr std::uint64_t kUpperChildMask = 28;
constexpr std::uint64_t kUpperValueMask = kUpperChildMask + 4096;
constexpr std::uint64_t kUpperValues = kUpperValueMask + 4096;

TEST(VdbTopology, CountsNodesAndBoundsActiveVoxels) {
  OpenVdbGrid grid(GridKind::int64, "a");
  grid.fill({{-1, -1, -1}, {1, 1, 1}}).fill({{100, 200, 300}, {101, 201, 301}}).tile(3, {8192, 0, 0}, 1, true);
  grid.tile(3, {16384, 0, 0}, 1, false);
  for (const auto compression : {Compression::none, Compression::zip_active_mask, Compression::blosc_active_mask}) {
    const VdbTopology topology = walk(grid, compression);
    EXPECT_EQ(topology.nodes, (std::array<std::uint64_t, 3>{9, 9, 8}));
    EXPECT_EQ(topology.root_entries, 10U);
    EXPECT_EQ(topology.active, grid.active());
    EXPECT_EQ(topology.background, 0);
    EXPECT_EQ(walk(one_leaf(), compression).background, 2);
  }
  EXPECT_TRUE(walk(OpenVdbGrid(GridKind::boolean, "empty")).active.empty());
}

TEST(VdbTopology, EstimatesTheMemoryThatOpenVdbCounts) {
  for (const GridKind kind : {GridKind::float32, GridKind::float64, GridKind::int32, GridKind::boolean}) {
    OpenVdbGrid grid(kind, "a");
    grid.fill({{-60, -60, -60}, {60, 60, 60}});
    const std::string tree = kind == GridKind::float32   ? "Tree_float_5_4_3"
                             : kind == GridKind::float64 ? "Tree_double_5_4_3"
                             : kind == GridKind::int32   ? "Tree_int32_5_4_3"
                                                         : "Tree_bool_5_4_3";
    const auto estimate = static_cast<double>(openvdb_library("a test").tree_bytes(*vdb_type(tree), walk(grid)));
    const auto counted = static_cast<double>(grid.memory_bytes());
    EXPECT_GE(estimate, counted) << tree;
    EXPECT_LE(estimate, counted * 1.25) << tree;
  }
}

struct Damage {
  Compression compression;
  std::uint64_t at;  ///< byte offset from the tree's beginning
  std::uint64_t value;
  std::size_t bytes;
  const char* message;
};

TEST(VdbTopology, RefusesInvalidTopology) {
  const std::vector<Damage> damages{
      {Compression::none, kBufferCount, 2, 4,
       "a tree of 2 buffers, and 1 can be read; write the file again with "
       "OpenVDB 10"},
      {Compression::none, kChildren, 0xFFFFFFFF, 4, "a root of 4294967295 entries, at most 262144 can be read"},
      {Compression::none, kOrigin, 8, 4, "an entry of the root at 8,0,0, which is no multiple of 4096 or there twice"},
      {Compression::none, kUpperValueMask, 1, 1, "an entry of the node at 0,0,0 is both tile and child"},
      {Compression::none, kUpperValues, 7, 1, "values of kind 7, at most 6"},
      // A negative length of a zipped run stands for uncompressed bytes, here more than the buffer has: an overflow.
      {Compression::zip, kUpperValues + 1, ~std::uint64_t{0} << 20U, 8,
       "131072 bytes of values are stored in -1048576; the file is damaged"},
      {Compression::zip, kUpperValues + 1, std::uint64_t{1} << 63U, 8,
       "131072 bytes of values are stored in -9223372036854775808; the file is damaged"},
      {Compression::zip, kUpperValues + 1, std::uint64_t{1} << 40U, 8,
       "131072 bytes of values are compressed to 1099511627776; the file is damaged"}};
  for (const Damage& damage : damages) {
    const std::string message = message_of_error(ErrorKind::input, [&] {
      walk(one_leaf(), damage.compression, [&](std::string& bytes, std::uint64_t tree) {
        bytes.replace(tree + damage.at, damage.bytes, reinterpret_cast<const char*>(&damage.value), damage.bytes);
      });
    });
    EXPECT_TRUE(message.starts_with("a.vdb: at byte ")) << message;
    EXPECT_TRUE(message.ends_with(std::string(": ") + damage.message)) << message;
  }
}

TEST(VdbTopology, BloscChunksOfTheWrongLengthAreRefused) {
  const std::string message = message_of_error(ErrorKind::input, [&] {
    walk(one_leaf(), Compression::blosc, [](std::string& bytes, std::uint64_t tree) {
      put(bytes, tree + kUpperValues + 1 + 8 + 12, std::uint32_t{0x7FFFFFFF});
    });
  });
  EXPECT_NE(message.find(": a blosc chunk of 2147483647 bytes stored in "), std::string::npos) << message;
}

TEST(VdbTopology, RefusesARootEntryThatIsThereTwice) {
  const std::string message = message_of_error(ErrorKind::input, [&] {
    OpenVdbGrid grid(GridKind::float32, "a");
    walk(grid.tile(3, {0, 0, 0}, 1, true).tile(3, {4096, 0, 0}, 1, true), Compression::none,
         [](std::string& bytes, std::uint64_t tree) { put(bytes, tree + kOrigin + 17, 0); });
  });
  EXPECT_TRUE(message.ends_with("an entry of the root at 0,0,0, which is no multiple of 4096 or there twice"))
      << message;
}

}  // namespace
}  // namespace weir::vdb_topology_test
