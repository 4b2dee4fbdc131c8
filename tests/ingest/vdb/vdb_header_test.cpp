#include "ingest/vdb/vdb_header.h"

#include <fstream>
#include <sstream>

#include "tests/ingest/support/scratch.h"
#include "tests/stock/openvdb_file.h"

namespace weir::vdb_header_test {
namespace {

using test::GridKind;
using test::OpenVdbGrid;

std::string two_grids() {
  const Scratch scratch;
  OpenVdbGrid density(GridKind::float32, "density");
  density.fill({{0, 0, 0}, {1, 1, 1}}).place({0.5, 0.25, 2}, {1, 2, 3}).save_as_half();
  OpenVdbGrid turned(GridKind::boolean, "turned");
  turned.place({2, 2, 2}, {0, 0, 0}).rotate(1.5707963267948966);
  test::write_vdb(scratch.path("a.vdb"), {density, turned}, test::Compression::blosc_active_mask);
  std::ifstream in(scratch.path("a.vdb"), std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

VdbHeader parse(const std::string& bytes) {
  std::istringstream in(bytes);
  const std::string path = "a.vdb";
  VdbReader reader(in, bytes.size(), path);
  return read_vdb_header(reader);
}

std::string refusal(const std::string& bytes) {
  return message_of_error(ErrorKind::input, [&] { parse(bytes); });
}

std::string with(std::string bytes, std::size_t at, std::uint32_t value) {
  return bytes.replace(at, 4, reinterpret_cast<const char*>(&value), 4);
}

TEST(VdbHeader, ParsesAHeaderWrittenByOpenVdb) {
  const VdbHeader header = parse(two_grids());
  EXPECT_EQ(header.version, 224U);
  EXPECT_EQ(header.library_major, 10U);
  ASSERT_EQ(header.grids.size(), 2U);
  const VdbGrid& density = header.grids[0];
  EXPECT_EQ(density.name, "density");
  EXPECT_EQ(density.tree, "Tree_float_5_4_3");
  EXPECT_TRUE(density.half);
  EXPECT_EQ(density.parent, "");
  EXPECT_EQ(density.compression, kVdbBlosc | kVdbActiveMask);
  EXPECT_EQ(density.map, "ScaleTranslateMap");
  EXPECT_EQ(density.steps, (std::array<Vector3, 3>{{{0.5, 0, 0}, {0, 0.25, 0}, {0, 0, 2}}}));
  EXPECT_EQ(density.first, (Vector3{1, 2, 3}));
  const VdbGrid& turned = header.grids[1];
  EXPECT_FALSE(turned.half);
  EXPECT_EQ(turned.map, "AffineMap");
  // A quarter turn: the x of the index runs along the world's y, or against it.
  EXPECT_NEAR(std::abs(turned.steps[0][1]), 2, 1e-12);
  EXPECT_NEAR(turned.steps[0][0], 0, 1e-12);
  EXPECT_NEAR(turned.steps[2][2], 2, 1e-12);
}

TEST(VdbHeader, RefusesOtherVersionsAndImpossibleSizes) {
  const std::string whole = two_grids();
  EXPECT_EQ(refusal(with(whole, 8, 221)),
            "a.vdb: at byte 12: file format 221, and 222 to 224 can be read; write the file again with OpenVDB 10");
  EXPECT_EQ(refusal(with(whole, 8, 225)),
            "a.vdb: at byte 12: file format 225, and 222 to 224 can be read; write the file again with OpenVDB 10");
  // The file's own metadata come after magic, versions, flag and uuid. Here there are none.
  constexpr std::size_t kMetadata = 8 + 4 + 8 + 1 + 36;
  EXPECT_EQ(refusal(with(whole, kMetadata + 4, 5000)),
            "a.vdb: at byte 65: 5000 grids, at most 4096 can be read; the file is damaged");
  EXPECT_EQ(refusal(with(whole, kMetadata + 8, 0xFFFFFFFF)),
            "a.vdb: at byte 69: a name of 4294967295 bytes; the file is damaged");
  EXPECT_EQ(refusal("BDV"), "a.vdb: does not begin as an OpenVDB file does");
}

TEST(VdbHeader, RefusesGridsPlacedBeforeTheirDescriptor) {
  std::string bytes = two_grids();
  const std::size_t name = bytes.find("Tree_float_5_4_3_HalfFloat");
  ASSERT_NE(name, std::string::npos);
  const std::size_t position = name + 26 + 4;  // behind the type and the length of the empty parent name
  bytes.replace(position, 8, 8, '\0');
  const std::string message = refusal(bytes);
  EXPECT_NE(message.find(": grid 'density' is to lie at bytes 0 to "), std::string::npos) << message;
}

}  // namespace
}  // namespace weir::vdb_header_test
