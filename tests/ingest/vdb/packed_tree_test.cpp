#include "ingest/vdb/packed_tree.h"

#include <gtest/gtest.h>

#include "format/base/little_endian.h"
#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/nvdb_grid.h"
#include "ingest/source_registry.h"
#include "ingest/vdb/nvdb_source.h"
#include "tests/ingest/support/header_file.h"
#include "tests/support/packed_sample.h"

namespace weir::packed_tree_test {
namespace {

using test::PackedSample;

TEST(PackedTree, Read_PackedFile_GivesTheDecodedVoxels) {
  const Scratch scratch;
  const std::string path = scratch.write("a.nvdb", PackedSample::build().file);
  const auto source = open_source(path, {});
  EXPECT_EQ(source->info().domain(), PackedSample::kDomain);
  EXPECT_EQ(source->info().dataset, "packed");
  for (const Box& box : {PackedSample::kDomain, Box{{-5, 3, 10}, {-4, 4, 11}}, Box{{120, 10, 30}, {140, 20, 40}}}) {
    std::vector<float> values(static_cast<std::size_t>(box.voxels()));
    source->read(box, values);
    std::size_t next = 0;
    for_each_index(box, [&](const Index3& i) {
      ASSERT_EQ(values[next++], PackedSample::value(i)) << i.x << ' ' << i.y << ' ' << i.z;
    });
  }
  EXPECT_GT(source->bytes_read(), 0U);
}

TEST(PackedTree, Read_PartOfTheVolume_ReadsItsGroupsAlone) {
  const Scratch scratch;
  const test::PackedFile made = PackedSample::build();
  const auto source = open_source(scratch.write("a.nvdb", made.file), {});
  const std::uint64_t before = source->bytes_read();
  std::vector<float> values(512);
  source->read({{8 * 17, 8, 16}, {8 * 18, 16, 24}}, values);
  EXPECT_LT(source->bytes_read() - before, packed::chunk::kGroups + 16 * 2051);
}

TEST(PackedTree, Read_DamagedSince_IsReported) {
  const Scratch scratch;
  test::PackedFile made = PackedSample::build();
  const std::string path = scratch.write("a.nvdb", made.file);
  const auto source = open_source(path, {});
  std::vector<float> values(static_cast<std::size_t>(PackedSample::kDomain.voxels()));
  store(std::span(made.file), made.chunks.at(0) + packed::chunk::kBases + 4 * 240,
        4U);  // the group of the blocks at x -1, y 0
  scratch.write("a.nvdb", made.file);
  const std::string message = message_of_error(ErrorKind::input, [&] { source->read(PackedSample::kDomain, values); });
  EXPECT_NE(message.find("group 240 of blocks lies in bytes 4 to"), std::string::npos) << message;
}

TEST(PackedTree, Open_PackedLevelSet_KeepsClassAndBackground) {
  const Scratch scratch;
  std::vector<std::byte> bytes = PackedSample::build().file;
  const SourceInfo before = open_source(scratch.write("a.nvdb", bytes), {})->info();
  EXPECT_EQ(before.grid_class, GridClass::unknown);
  EXPECT_FALSE(before.background);
  const auto grid = NvdbGrid::open(bytes, "a.nvdb").grid_offset();
  store(std::span(bytes), grid + nvdb::grid::kGridClass, std::uint32_t{1});
  store(std::span(bytes), grid + nvdb::kRootOffset + nvdb::root::kBackground, 3.0F);
  const SourceInfo level_set = open_source(scratch.write("b.nvdb", bytes), {})->info();
  EXPECT_EQ(level_set.grid_class, GridClass::level_set);
  EXPECT_EQ(level_set.background, 3.0F);
}

TEST(PackedTree, List_PackedFile_SaysSo) {
  const Scratch scratch;
  const auto list = list_nvdb(scratch.write("a.nvdb", PackedSample::build().file), {});
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].type, "float32 packed");
}

}  // namespace
}  // namespace weir::packed_tree_test
