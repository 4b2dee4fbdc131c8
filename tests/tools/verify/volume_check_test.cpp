#include "tools/verify/volume_check.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/tools/support/converted_volume.h"

namespace weir::volume_check_test {
namespace {

using VolumeCheckTest = ConvertedVolume;

std::string failed_names(const std::vector<VolumeCheck>& checks) {
  std::string names;
  for (const VolumeCheck& check : checks) {
    if (!check.ok) names += check.name + '\n';
  }
  return names;
}

// Changing any single key of the sidecar that verify compares fails exactly that check.
TEST_F(VolumeCheckTest, EachKeyOfTheSidecarIsCompared) {
  const NvdbFile file = open();
  const TreeCensus census = take_census(file.grid(), {});
  const Sidecar good = sidecar();
  const auto failed = [&](const std::function<void(Sidecar&)>& change) {
    Sidecar changed = good;
    change(changed);
    return failed_names(check_sidecar(file.grid(), census, good.file.digest, changed));
  };
  EXPECT_EQ(failed([](Sidecar&) {}), "");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.file.bytes; }), "sidecar file.bytes\n");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.budget.file_bytes; }), "sidecar budget.file_bytes\n");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.file.grid_offset; }), "sidecar file.grid_offset\n");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.file.head_checksum; }), "sidecar file.head_checksum\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.file.digest[0] ^= 1; }), "sidecar file.digest\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.grid.name += 'x'; }), "sidecar grid.name\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.grid.type = "fpn"; }), "sidecar grid.type\n");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.grid.index_bbox.hi.z; }), "sidecar grid.index_bbox\n");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.grid.extent.y; }), "sidecar grid.extent\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.grid.voxel_size[2] = 2; }), "sidecar grid.voxel_size\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.grid.origin[0] = 2; }), "sidecar grid.origin\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.background.value += 1; }), "sidecar background.value\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.value_range[1] = 1, s.error.max_abs = 0; }), "sidecar value_range\n");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.selection.bits[0]; }), "sidecar selection.bits\n");
  EXPECT_EQ(failed([](Sidecar& s) { --s.selection.leaves_kept; }), "sidecar selection.leaves_kept\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.macrocells.cell = 8; }), "sidecar macrocells.cell\n");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.macrocells.dims.x; }), "sidecar macrocells.dims\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.macrocells.apron = 0; }), "sidecar macrocells.apron\n");
}

}  // namespace
}  // namespace weir::volume_check_test
