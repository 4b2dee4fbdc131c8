// Reads published volumes with what their file names say, and compares them with the figures in the data's manifest.
// Volumes that are not on this machine are skipped.
#include <algorithm>
#include <cstdlib>
#include <limits>

#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source_registry.h"
#include "tests/ingest/support/scratch.h"

namespace weir::real_volumes_test {
namespace {

struct Volume {
  const char* file;
  Index3 extent;
  float min;
  float max;
  float mode;
  double mode_percent;  ///< share of the voxels with the value `mode`, to two decimals
};

class RealVolumes : public ::testing::TestWithParam<Volume> {};

TEST_P(RealVolumes, StreamInBlocksWithTheirPublishedFigures) {
  const Volume& expected = GetParam();
  const auto packed = std::filesystem::path(WEIR_SOURCE_DIR) / "../shared/data" / (std::string(expected.file) + ".xz");
  if (!std::filesystem::exists(packed)) GTEST_SKIP() << "skipped: no " << packed;
  const Scratch scratch;
  const std::string path = scratch.path(expected.file);
  ASSERT_EQ(std::system(("xz -dc '" + packed.string() + "' > '" + path + "'").c_str()), 0) << "xz-utils missing?";

  const auto source = open_source(path, {});
  ASSERT_EQ(source->info().extent, expected.extent);
  // Blocks are small, so that the volume has several.
  const BlockPlan plan = plan_blocks(source->info().domain(), source->access(), 300'000);
  std::vector<Box> boxes;
  for (std::int64_t i = 0; i < plan.size(); ++i) boxes.push_back(plan.voxel_box(plan.leaf_box(i)));
  ASSERT_GT(boxes.size(), 1U);
  float lo = std::numeric_limits<float>::infinity();
  float hi = -lo;
  std::int64_t at_mode = 0;
  std::int64_t voxels = 0;
  const ConversionLoss loss = stream_blocks(*source, boxes, {}, [&](const Block& block) {
    const auto [least, most] = std::minmax_element(block.values.begin(), block.values.end());
    lo = std::min(lo, *least);
    hi = std::max(hi, *most);
    at_mode += std::count(block.values.begin(), block.values.end(), expected.mode);
    voxels += std::ssize(block.values);
  });
  EXPECT_EQ(voxels, volume(expected.extent));
  EXPECT_EQ(lo, expected.min);
  EXPECT_EQ(hi, expected.max);
  EXPECT_NEAR(100.0 * static_cast<double>(at_mode) / static_cast<double>(voxels), expected.mode_percent, 0.005);
  EXPECT_EQ(loss.inexact + loss.overflow, 0U);
}

INSTANTIATE_TEST_SUITE_P(Manifest, RealVolumes,
                         ::testing::Values(Volume{"aneurism_256x256x256_uint8.raw", {256, 256, 256}, 0, 255, 0, 98.99},
                                           Volume{"tooth_103x94x161_uint8.raw", {103, 94, 161}, 0, 255, 77, 9.64},
                                           Volume{
                                               "mni152_2009_193x229x193_int16.raw", {193, 229, 193}, 0, 1570, 0, 78.54},
                                           Volume{"carotid_76x49x45_float32be.raw", {76, 49, 45}, 0, 580, 127, 2.62}),
                         [](const auto& volume) {
                           const std::string file = volume.param.file;
                           return file.substr(0, file.find('_'));
                         });

}  // namespace
}  // namespace weir::real_volumes_test
