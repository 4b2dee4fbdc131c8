// Tests that OpenVDB reads a node's values as weir wrote them, for every way to store inactive values.
#include "tools/export/vdb_node_values.h"

#include <gtest/gtest.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/io.h>
#include <openvdb/util/NodeMasks.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include "ingest/vdb/vdb_header.h"

namespace weir::vdb_node_values_test {
namespace {

using LeafMask = openvdb::util::NodeMask<3>;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Node {
  std::vector<float> values = std::vector<float>(512, 1.5F);
  std::array<std::uint64_t, 8> active{};
  std::array<std::uint64_t, 8> children{};

  Node() { active.fill(~std::uint64_t{0}); }
  void set_off(std::size_t i, float value) {
    values[i] = value;
    active[i / 64] &= ~(std::uint64_t{1} << i % 64);
  }
};

std::string written(const Node& node, const VdbStorage& storage) {
  std::ostringstream out;
  write_vdb_values(out, node.values, node.active, node.children, storage);
  return out.str();
}

/// Returns the number of entries, without children, that OpenVDB reads with other bits; -1 if it does not read exactly
/// to the end.
int differing(const Node& node, const VdbStorage& storage) {
  std::istringstream in(written(node, storage));
  openvdb::io::setCurrentVersion(in);
  openvdb::io::setDataCompression(in, storage.compression | kVdbActiveMask);
  openvdb::io::setGridBackgroundValuePtr(in, &storage.background);
  LeafMask mask;
  for (openvdb::Index i = 0; i < 512; ++i) mask.set(i, (node.active[i / 64] >> i % 64 & 1U) != 0);
  std::vector<float> read(512);
  openvdb::io::readCompressedValues(in, read.data(), 512, mask, storage.half);
  if (!in || in.peek() != std::istringstream::traits_type::eof()) return -1;
  int count = 0;
  for (std::size_t i = 0; i < 512; ++i) {
    const bool child = (node.children[i / 64] >> i % 64 & 1U) != 0;
    count += !child && std::bit_cast<std::uint32_t>(read[i]) != std::bit_cast<std::uint32_t>(node.values[i]) ? 1 : 0;
  }
  return count;
}

std::vector<VdbStorage> every_storage(float background) {
  std::vector<VdbStorage> all;
  for (const std::uint32_t compression : {std::uint32_t{0}, kVdbZip, kVdbBlosc}) {
    for (const bool half : {false, true}) all.push_back({compression, half, background});
  }
  return all;
}

struct Case {
  const char* name;
  Node node;
  std::uint8_t kind;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  all.push_back({"all active", {}, 0});
  Case background{"background", {}, 0};
  background.node.set_off(3, 0.0F);
  background.node.set_off(511, 0.0F);
  all.push_back(background);
  Case minus{"negative zero is not the background", {}, 2};
  minus.node.set_off(64, -0.0F);
  all.push_back(minus);
  Case nan{"NaN", {}, 2};
  nan.node.set_off(0, kNan);
  nan.node.set_off(1, kNan);
  all.push_back(nan);
  Case two{"two, one the background", {}, 5};
  two.node.set_off(7, 0.0F);
  two.node.set_off(8, -0.0F);
  two.node.set_off(400, 0.0F);
  all.push_back(two);
  Case three{"three", {}, 6};
  for (const std::size_t i : {5U, 6U, 7U}) three.node.set_off(i, static_cast<float>(i));
  all.push_back(three);
  Case none{"none active", {}, 2};
  for (std::size_t i = 0; i < 512; ++i) none.node.set_off(i, 2.0F);
  all.push_back(none);
  Case child{"values of children don't count", {}, 0};
  child.node.set_off(9, 77.0F);
  child.node.children[0] = std::uint64_t{1} << 9U;
  all.push_back(child);
  Case noise{"values that don't compress", {}, 0};
  for (std::size_t i = 0; i < 512; ++i) noise.node.values[i] = static_cast<float>(i * 2654435761U % 2048) * 0.125F;
  all.push_back(noise);
  return all;
}

TEST(VdbNodeValues, OpenVdbReadsEveryKind) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    for (const VdbStorage& storage : every_storage(0.0F)) {
      EXPECT_EQ(differing(c.node, storage), 0) << storage.compression << ' ' << storage.half;
      EXPECT_EQ(static_cast<std::uint8_t>(written(c.node, storage)[0]), c.kind);
    }
  }
}

TEST(VdbNodeValues, OnlyActiveValuesAreStored) {
  Node node;
  for (std::size_t i = 12; i < 512; ++i) node.set_off(i, 0.25F);
  EXPECT_EQ(written(node, {0, false, 0.25F}).size(), 1U + 12 * 4);
  EXPECT_EQ(written(node, {0, true, 0.25F}).size(), 1U + 12 * 2);
  EXPECT_EQ(written(node, {0, false, 0.0F}).size(), 1U + 4 + 12 * 4);
}

TEST(VdbNodeValues, HalfRounding) {
  EXPECT_EQ(rounded_to_half(1.0F), 1.0F);
  EXPECT_EQ(rounded_to_half(1.0F + 0x1p-11F), 1.0F);  // ties to even
  EXPECT_EQ(rounded_to_half(1.0F + 0x1.8p-10F), 1.0F + 0x1p-9F);
  EXPECT_EQ(rounded_to_half(kMaxHalf), kMaxHalf);
  EXPECT_EQ(rounded_to_half(65519.0F), kMaxHalf);
  EXPECT_TRUE(std::isinf(rounded_to_half(65520.0F)));
  EXPECT_EQ(rounded_to_half(0x1p-24F), 0x1p-24F);  // the smallest positive value
  EXPECT_EQ(rounded_to_half(0x1p-26F), 0.0F);
  EXPECT_TRUE(std::isnan(rounded_to_half(kNan)));
  EXPECT_TRUE(std::signbit(rounded_to_half(-0.0F)));
}

}  // namespace
}  // namespace weir::vdb_node_values_test
