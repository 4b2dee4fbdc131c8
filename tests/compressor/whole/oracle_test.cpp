// Compares conversions with OpenVDB and stock NanoVDB: the same values and active voxels everywhere, and the same bytes
// in every node.
#include <gtest/gtest.h>

#include <algorithm>
#include <bitset>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "format/base/little_endian.h"
#include "format/layout/nanovdb_layout.h"
#include "ingest/synthetic/synthetic.h"
#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/packed_files.h"
#include "tests/stock/stock_tree.h"

namespace weir::oracle_test {
namespace {

using test::bits_of;
using test::Converted;
using test::MemoryVolume;
using test::StockReader;
using test::StockTree;

using Bytes = std::span<const std::byte>;

struct Expected {
  const MemoryVolume& volume;
  FillMode fill;
  NonFinitePolicy policy;
  float background;

  float voxel(const Index3& i) const {
    const float v = volume.at(i);
    return policy == NonFinitePolicy::keep || std::isfinite(v) ? v : background;
  }
};

// Builds the tree that the file claims to hold, with values and states from the volume itself.
StockTree tree_of(const Converted& converted, const Expected& expected) {
  const NvdbGrid grid = converted.grid();
  const Box domain = expected.volume.info().domain();
  StockTree tree(expected.background);
  std::int64_t covered = 0;
  grid.for_each_block([&](const GridBlock& block) {
    const Box box{block.origin, block.origin + Index3{block.dim, block.dim, block.dim}};
    const Box inside = intersect(box, domain);
    if (inside.empty()) return;  // never set: background, off
    covered += inside.voxels();
    if (block.leaf == nullptr) {
      const float value = test::expected_tile(expected.volume, box, expected.fill, expected.background);
      tree.add_tile(block.origin, block.dim, value, expected.fill == FillMode::mean && inside == box);
      return;
    }
    std::array<float, 512> values;
    std::bitset<512> active;
    for (unsigned n = 0; n < 512; ++n) {
      const Index3 i = block.origin + Index3{n >> 6U, n >> 3U & 7U, n & 7U};
      active[n] = domain.contains(i);
      values[n] = active[n] ? expected.voxel(i) : expected.background;
    }
    tree.add_leaf(block.origin, values, active);
  });
  EXPECT_EQ(covered, domain.voxels());
  return tree;
}

// Blanks the bytes of a node that stock leaves undefined or inverted if nothing in the node is active.
void blank_statistics(std::vector<std::byte>& node, const nvdb::InternalLayout& layout) {
  std::fill_n(node.begin(), nvdb::kNodeFlags, std::byte{0});
  std::fill_n(node.begin() + static_cast<std::ptrdiff_t>(layout.min), 16, std::byte{0});
}

void expect_same_nodes(Bytes ours, Bytes stock, std::uint64_t count, const nvdb::InternalLayout& layout,
                       const std::string& level) {
  for (std::uint64_t i = 0; i < count; ++i) {
    const Bytes a = ours.subspan(i * layout.bytes, layout.bytes);
    const Bytes b = stock.subspan(i * layout.bytes, layout.bytes);
    std::vector<std::byte> left(a.begin(), a.end());
    std::vector<std::byte> right(b.begin(), b.end());
    if ((load<std::uint64_t>(a, nvdb::kNodeFlags) & 2U) == 0) {
      blank_statistics(left, layout);
      blank_statistics(right, layout);
    }
    const auto differ = std::mismatch(left.begin(), left.end(), right.begin());
    ASSERT_EQ(differ.first - left.begin(), static_cast<std::ptrdiff_t>(layout.bytes)) << level << " node " << i;
  }
}

// Expects the same bytes from `begin` to `end`, counted from the start of each span.
void expect_same(Bytes ours, Bytes stock, std::uint64_t begin, std::uint64_t end, const std::string& part) {
  const Bytes a = ours.subspan(begin, end - begin);
  const Bytes b = stock.subspan(begin, end - begin);
  EXPECT_EQ(std::mismatch(a.begin(), a.end(), b.begin()).first - a.begin(), std::ssize(a)) << part << " from " << begin;
}

// The voxel size equals the given spacing. Stock derives its voxel size from transformed points, which rounds.
void expect_voxel_size(Bytes ours, Bytes stock, std::uint64_t offset, const std::array<double, 3>& spacing) {
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(load<double>(ours, offset + 8 * i), spacing[i]);
    EXPECT_NEAR(load<double>(stock, offset + 8 * i), spacing[i], 1e-13);
  }
}

void expect_stock_bytes(const Converted& converted, Bytes stock_file, const std::array<double, 3>& spacing) {
  const NvdbGrid grid = converted.grid();
  const std::uint64_t stock_grid = nvdb::kNameOffset + load<std::uint32_t>(stock_file, nvdb::meta::kNameSize);
  const Bytes ours = Bytes(converted.file).subspan(grid.grid_offset());
  const Bytes stock = stock_file.subspan(stock_grid);
  const auto [leaves, lowers, uppers] = grid.node_counts();
  // File meta data: all members except grid size, file size, name size and blind-data count.
  namespace meta = nvdb::meta;
  expect_same(converted.file, stock_file, 0, meta::kGridSize, "file header");
  expect_same(converted.file, stock_file, meta::kNameKey, meta::kVoxelSize, "meta data");
  expect_voxel_size(converted.file, stock_file, meta::kVoxelSize, spacing);
  expect_same(converted.file, stock_file, meta::kNodeCount, meta::kBlindCount, "meta data");
  expect_same(converted.file, stock_file, meta::kVersion, nvdb::kNameOffset, "meta data");
  // Grid: all members except checksum, size and blind data.
  expect_same(ours, stock, 0, nvdb::grid::kChecksum, "grid");
  expect_same(ours, stock, nvdb::grid::kVersion, nvdb::grid::kGridSize, "grid");
  expect_same(ours, stock, nvdb::grid::kName, nvdb::grid::kVoxelSize, "grid");
  expect_voxel_size(ours, stock, nvdb::grid::kVoxelSize, spacing);
  expect_same(ours, stock, nvdb::grid::kGridClass, nvdb::grid::kBlindOffset, "grid");
  expect_same(ours, stock, nvdb::kTreeOffset, nvdb::kTreeOffset + nvdb::kTreeBytes, "tree");
  const std::uint64_t upper_at = nvdb::kRootTilesOffset + grid.root_tiles() * nvdb::kRootTileBytes;
  expect_same(ours, stock, nvdb::kRootOffset, upper_at, "root");
  const std::uint64_t lower_at = upper_at + uppers * nvdb::kUpperBytes;
  const std::uint64_t leaf_at = lower_at + lowers * nvdb::kLowerBytes;
  expect_same_nodes(ours.subspan(upper_at), stock.subspan(upper_at), uppers, nvdb::kUpper, "upper");
  expect_same_nodes(ours.subspan(lower_at), stock.subspan(lower_at), lowers, nvdb::kLower, "lower");
  const std::uint64_t end = leaf_at + leaves * nvdb::kFloatLeafBytes;
  EXPECT_EQ(stock.size(), end);
  expect_same(ours, stock, leaf_at, end, "leaves");
  const Bytes padding = ours.subspan(grid.data_bytes());
  EXPECT_TRUE(std::all_of(padding.begin(), padding.end(), [](std::byte b) { return b == std::byte{0}; }));
}

// Compares the file with the OpenVDB tree, both read by the stock reader.
void expect_stock_reads_the_same(const Converted& converted, const Expected& expected, Bytes stock_file) {
  const StockReader ours(converted.file);
  const StockReader stock(stock_file);
  EXPECT_TRUE(ours.valid());
  EXPECT_EQ(ours.name(), "density");
  EXPECT_EQ(ours.active_voxels(), stock.active_voxels());
  const Box domain = expected.volume.info().domain();
  EXPECT_EQ(ours.index_bbox(), domain);
  const Index3 margin{11, 11, 11};
  const Box box{domain.lo - margin, domain.hi + margin};
  for (std::int64_t n = 0; n < box.voxels(); ++n) {
    const Index3 i = box.lo + index_at(n, box.extent());
    ASSERT_EQ(bits_of(ours.value(i)), bits_of(stock.value(i))) << i.x << ' ' << i.y << ' ' << i.z;
    ASSERT_EQ(ours.active(i), stock.active(i)) << i.x << ' ' << i.y << ' ' << i.z;
  }
}

// If `scan` is set, also reads every voxel, although the same bytes already imply the same values.
void expect_oracle(MemoryVolume& volume, const ConversionOptions& options, std::uint64_t file_bytes, bool scan) {
  SCOPED_TRACE("file of " + std::to_string(file_bytes) + " bytes, " + metric_name(options.metric) + ", fill " +
               fill_name(options.fill) + ", brick " + std::to_string(options.brick) + ", " +
               policy_name(options.non_finite));
  const Converted converted = test::convert_to(volume, options, file_bytes);
  ASSERT_EQ(converted.file.size(), file_bytes);
  const Expected expected{volume, options.fill, options.non_finite, converted.grid().background()};
  const StockTree tree = tree_of(converted, expected);
  const auto stock = tree.file("density", volume.info().spacing, volume.info().origin);
  if (scan) expect_stock_reads_the_same(converted, expected, stock);
  expect_stock_bytes(converted, stock, volume.info().spacing);
  const Box domain = volume.info().domain();
  for (const Index3& corner : {domain.lo, domain.hi - Index3{1, 1, 1}}) {
    EXPECT_NE(converted.grid().block_at(corner).leaf, nullptr);
  }
}

std::uint64_t lossless_size(MemoryVolume& volume, ConversionOptions options) {
  options.budget.kind = Budget::Kind::lossless;
  return test::convert(volume, options).file.size();
}

// Returns the minimum size, the lossless size, a larger size, and odd sizes between them.
std::vector<std::uint64_t> sizes(MemoryVolume& volume, const ConversionOptions& options) {
  const std::uint64_t minimum = test::minimum_size(volume, options);
  const std::uint64_t lossless = lossless_size(volume, options);
  std::vector<std::uint64_t> all{minimum, lossless, lossless + 12345};
  for (const std::uint64_t part : {1U, 3U, 6U}) all.push_back(minimum + (lossless - minimum) * part / 7);
  return all;
}

float wave(const Index3& i) {
  const auto x = static_cast<float>(i.x);
  const auto y = static_cast<float>(i.y);
  const auto z = static_cast<float>(i.z);
  return std::sin(0.37F * x) + 0.25F * std::cos(0.011F * y * z) + 0.01F * z;
}

// Half of the volume has one value, so that some regions are not worth a node.
float island(const Index3& i) { return i.x * i.x + i.y * i.y + i.z * i.z < 60 * 60 ? wave(i) : 0.125F; }

struct Case {
  std::string name;
  Box domain;
  std::function<float(const Index3&)> value;
  std::array<double, 3> spacing{1, 1, 1};
  std::array<double, 3> origin{0, 0, 0};
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

float noise(const Index3& i) {
  std::minstd_rand random(static_cast<unsigned>(i.x * 7919 + i.y * 104729 + i.z * 1299709 + 17));
  random.discard(2);
  return static_cast<float>(random()) * 0x1p-30F - 1.0F;
}

std::vector<Case> cases() {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  return {
      {"Wave", {{0, 0, 0}, {45, 38, 27}}, wave, {0.3, 0.3, 0.3}},
      {"NegativeOrigin", {{-139, -17, -131}, {-1, 130, 5}}, wave, {0.25, 0.5, 2}, {10, -20, 30.5}},
      {"InexactTransform", {{-7, 3, 100}, {50, 21, 140}}, wave, {0.1, 0.7, 1.3}, {0.3, -1.1, 0.7}},
      {"WholeLowerNode", {{0, 0, 0}, {128, 128, 128}}, island},
      {"ManyRegions", {{-150, -131, -140}, {140, 20, 10}}, island},
      {"ThreeUppersLong", {{-4100, -4, 0}, {4105, 5, 10}}, island},
      {"FourUppers", {{4000, -120, 4090}, {4110, 10, 4100}}, wave},
      {"OneVoxel", {{5, -9, 4095}, {6, -8, 4096}}, wave},
      {"Needle", {{0, 0, -300}, {1, 1, 17}}, wave},
      {"Constant", {{-3, 0, 0}, {260, 40, 30}}, [](const Index3&) { return 0.5F; }},
      {"WhiteNoise", {{0, 0, 0}, {50, 33, 17}}, noise},
      {"SomeNaN",
       {{0, 0, 0}, {41, 30, 30}},
       [](const Index3& i) { return (i.x + 3 * i.y + 7 * i.z) % 97 == 0 ? kNaN
                                    : i.x % 29 == 5                     ? kInf
                                                                        : wave(i); }},
      {"Zeros", {{0, 0, 0}, {33, 20, 20}}, [](const Index3& i) { return noise(i) < 0 ? -0.0F : 0.0F; }},
      {"Huge", {{0, 0, 0}, {40, 20, 20}}, [](const Index3& i) { return i.x % 2 == 0 ? -3e38F : 3e38F; }},
      {"Denormal",
       {{0, 0, 0}, {30, 20, 20}},
       [](const Index3& i) { return static_cast<float>(1 + (i.x * i.y + i.z) % 4096) * 0x1p-149F; }},
  };
}

std::vector<Case> small_cases() {
  std::vector<Case> small = cases();
  std::erase_if(small, [](const Case& c) { return c.domain.voxels() > 300'000; });
  return small;
}

class OracleTest : public testing::TestWithParam<Case> {};
class OracleMetricTest : public testing::TestWithParam<Case> {};

// A sphere. Many voxels inside the band have the lowest value, as many voxels outside have the highest.
TEST(OracleClass, LevelSetOfEveryEncoding_IsValidAndKeepsItsBackground) {
  MemoryVolume volume({{0, 0, 0}, {64, 64, 64}}, [](const Index3& i) {
    const Index3 from_centre = i - Index3{32, 32, 32};
    const auto [x, y, z] = from_centre;
    return std::clamp(std::sqrt(static_cast<float>(x * x + y * y + z * z)) - 28.0F, -3.0F, 3.0F);
  });
  volume.info().grid_class = GridClass::level_set;
  volume.info().background = 3.0F;
  for (const Encoding encoding : {Encoding::float32, Encoding::fpn, Encoding::fp4, Encoding::fp8, Encoding::fp16,
                                  Encoding::automatic, Encoding::packed}) {
    SCOPED_TRACE(encoding_name(encoding));
    ConversionOptions options;
    options.encoding = encoding;
    options.budget.kind = Budget::Kind::rate;
    options.budget.rate = 2;
    const Converted converted = test::convert(volume, options);
    const NvdbGrid grid = converted.grid();
    EXPECT_EQ(load<std::uint32_t>(grid.data(), nvdb::grid::kGridClass), 1U);
    EXPECT_EQ(grid.background(), 3.0F);
    EXPECT_EQ(converted.sidecar.background.method, "source");
    EXPECT_TRUE(StockReader(converted.file).valid());
  }
}

TEST_P(OracleTest, SameTreeAsOpenVdbAtEverySize) {
  const Case& c = GetParam();
  MemoryVolume volume(c.domain, c.value);
  volume.info().spacing = c.spacing;
  volume.info().origin = c.origin;
  const bool finite =
      std::all_of(volume.values().begin(), volume.values().end(), [](float v) { return std::isfinite(v); });
  ConversionOptions options;
  for (const NonFinitePolicy policy : {NonFinitePolicy::error, NonFinitePolicy::background, NonFinitePolicy::keep}) {
    if (finite != (policy == NonFinitePolicy::error)) continue;
    options.non_finite = policy;
    for (const FillMode fill : {FillMode::mean, FillMode::background}) {
      options.fill = fill;
      const auto all = sizes(volume, options);
      for (const std::uint64_t size : all) {
        expect_oracle(volume, options, size, size == all.back());
        if (HasFailure()) return;
      }
    }
  }
}

TEST_P(OracleMetricTest, SameTreeAsOpenVdbForEveryMetricAndBrick) {
  const Case& c = GetParam();
  MemoryVolume volume(c.domain, c.value);
  ConversionOptions options;
  options.non_finite = NonFinitePolicy::background;
  for (const Metric metric : {Metric::farthest, Metric::closest, Metric::median}) {
    for (const std::int64_t brick : {8, 16, 32}) {
      for (const FillMode fill : {FillMode::mean, FillMode::background}) {
        options.metric = metric;
        options.brick = brick;
        options.fill = fill;
        const std::uint64_t minimum = test::minimum_size(volume, options);
        expect_oracle(volume, options, minimum + (lossless_size(volume, options) - minimum) / 3, true);
        if (HasFailure()) return;
      }
    }
  }
}

TEST(PackedOracle, OutsideTheDomain_LeavesAreTheBackground) {
  MemoryVolume volume(test::kPackedDomain, test::smooth);
  ConversionOptions options = test::packed(Budget::Kind::psnr, 60);
  options.preview = Preview::on;
  const Converted converted = test::convert(volume, options);
  const auto background = static_cast<float>(converted.sidecar.background.value);
  const StockReader stock(converted.file);
  const NodeLattice leaves = make_lattice(test::kPackedDomain, kLeafDim);
  const Box last = leaves.node_box(leaves.count - Index3{1, 1, 1});
  int outside = 0;
  for (std::int64_t n = 0; n < last.voxels(); ++n) {
    const Index3 i = last.lo + index_at(n, last.extent());
    if (test::kPackedDomain.contains(i)) continue;
    ++outside;
    EXPECT_EQ(bits_of(stock.value(i)), bits_of(background)) << i.x << ' ' << i.y << ' ' << i.z;
    EXPECT_FALSE(stock.active(i));
  }
  EXPECT_EQ(outside, 512 - 5 * 6 * 5);
}

INSTANTIATE_TEST_SUITE_P(Volumes, OracleMetricTest, testing::ValuesIn(small_cases()),
                         [](const auto& parameter) { return parameter.param.name; });
INSTANTIATE_TEST_SUITE_P(Volumes, OracleTest, testing::ValuesIn(cases()),
                         [](const auto& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace weir::oracle_test
