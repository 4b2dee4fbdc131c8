#include "ingest/source/source_view.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "ingest/raw/raw_source.h"
#include "tests/ingest/support/scratch.h"
#include "tests/ingest/support/telling_source.h"

namespace weir::source_view_test {
namespace {

std::unique_ptr<VolumeSource> open_ramp(const Scratch& scratch) {
  std::vector<std::uint16_t> values(10 * 8 * 6);
  std::iota(values.begin(), values.end(), std::uint16_t{0});
  SourceOptions options;
  options.origin = {1.0, 2.0, 3.0};
  options.spacing = {0.5, 0.5, 0.5};
  return place_source(open_raw(scratch.write_values("v_10x8x6_uint16.raw", values), options), options);
}

TEST(SourceView, RegionKeepsIndicesAndOrigin) {
  const Scratch scratch;
  const auto source = crop_source(open_ramp(scratch), {{3, 2, 1}, {9, 8, 4}});
  const SourceInfo& info = source->info();
  EXPECT_EQ(info.extent, (Index3{6, 6, 3}));
  EXPECT_EQ(info.index_origin, (Index3{3, 2, 1}));
  EXPECT_EQ(info.domain(), (Box{{3, 2, 1}, {9, 8, 4}}));
  EXPECT_EQ(info.origin, (std::array<double, 3>{1.0, 2.0, 3.0}));  // the place of index (0, 0, 0), not of the region
  EXPECT_EQ(info.spacing, (std::array<double, 3>{0.5, 0.5, 0.5}));
  EXPECT_EQ(info.type, ScalarType::uint16);
  EXPECT_EQ(source->access().bytes_per_voxel, 2U);

  std::vector<float> values(4);
  source->read({{8, 7, 2}, {9, 8, 4}}, std::span(values).first(2));
  EXPECT_EQ(values[0], 8.0F + 10 * 7 + 80 * 2);
  EXPECT_EQ(values[1], 8.0F + 10 * 7 + 80 * 3);
  EXPECT_GE(source->bytes_read(), 4U);
}

TEST(SourceView, RegionOfARegion) {
  const Scratch scratch;
  auto source = crop_source(open_ramp(scratch), {{3, 2, 1}, {9, 8, 4}});
  source = crop_source(std::move(source), {{4, 4, 3}, {5, 5, 4}});
  std::vector<float> value(1);
  source->read(source->info().domain(), value);
  EXPECT_EQ(value[0], 4.0F + 10 * 4 + 80 * 3);
}

TEST(SourceView, RefusesEmptyAndOutside) {
  const Scratch scratch;
  const std::string path = scratch.path("v_10x8x6_uint16.raw");
  const auto refusal = [&](const Box& region) {
    return message_of_error(ErrorKind::usage, [&] { crop_source(open_ramp(scratch), region); });
  };
  EXPECT_EQ(refusal({{3, 2, 1}, {3, 8, 4}}),
            path + ": --roi 3:3,2:8,1:4 holds no voxel; each axis is FROM:TO with FROM below TO");
  EXPECT_EQ(refusal({{3, 2, 1}, {11, 8, 4}}),
            path + ": --roi 3:11,2:8,1:4 reaches outside the volume 0:10,0:8,0:6; keep it within");
  EXPECT_EQ(refusal({{-1, 2, 1}, {9, 8, 4}}),
            path + ": --roi -1:9,2:8,1:4 reaches outside the volume 0:10,0:8,0:6; keep it within");
}

TEST(SourceView, GhostCells_AreLeftOut_ButNotAllThereIs) {
  const Scratch scratch;
  VolumeRegion region;
  region.ghost = {2, 1, 0};
  const auto inner = crop_to(open_ramp(scratch), region);
  EXPECT_EQ(inner->info().domain(), (Box{{2, 1, 0}, {8, 7, 6}}));
  region.ghost = {5, 0, 0};
  EXPECT_EQ(
      message_of_error(ErrorKind::usage, [&] { crop_to(open_ramp(scratch), region); }),
      scratch.path("v_10x8x6_uint16.raw") +
          ": --ghost 5,0,0 leaves no voxel of 10 x 8 x 6; it is taken from both ends of each axis, give fewer layers");
}

TEST(SourceView, ReadsNothingOutsideTheRegion) {
  const Scratch scratch;
  const auto source = crop_source(open_ramp(scratch), {{3, 2, 1}, {9, 8, 4}});
  std::vector<float> value(1);
  EXPECT_EQ(message_of_error(ErrorKind::internal,
                             [&] {
                               source->read({{0, 0, 0}, {1, 1, 1}}, value);
                             }),
            scratch.path("v_10x8x6_uint16.raw") + ": read of box 0:1,0:1,0:1 outside the region 3:9,2:8,1:4");
}

TEST(SourceView, Region_HasTheValuesOfItsBoxes_AndNothingOfWholeVolumes) {
  Told told;
  const auto source = crop_source(std::make_unique<TellingSource>(told), {{2, 0, 0}, {10, 8, 8}});
  EXPECT_EQ(source->voxels_with_values({{2, 0, 0}, {10, 8, 8}}), (std::vector<Box>{{{2, 0, 0}, {6, 8, 8}}}));
  EXPECT_EQ(source->resident(), nullptr);
  EXPECT_EQ(source->places(), nullptr);
  EXPECT_EQ(source->held({{2, 0, 0}, {8, 8, 8}}), nullptr);
}

TEST(SourceView, PlacedVolume_AnswersAsItsSource) {
  Told told;
  SourceOptions options;
  options.spacing = {0.5, 0.5, 0.5};
  const auto source = place_source(std::make_unique<TellingSource>(told), options);
  EXPECT_EQ(source->info().spacing, (std::array<double, 3>{0.5, 0.5, 0.5}));
  EXPECT_EQ(source->voxels_with_values({{0, 0, 0}, {8, 8, 8}}), (std::vector<Box>{{{0, 0, 0}, {4, 8, 8}}}));
  EXPECT_EQ(source->held({{0, 0, 0}, {8, 8, 8}}), &told.held);
}

TEST(SourceView, RefusesInvalidSpacingAndOrigin) {
  const Scratch scratch;
  const std::string path = scratch.path("v_10x8x6_uint16.raw");
  const auto refusal = [&](const SourceOptions& options) {
    return message_of_error(ErrorKind::usage, [&] { place_source(open_ramp(scratch), options); });
  };
  SourceOptions options;
  options.spacing = {1.0, 0.0, 1.0};
  EXPECT_EQ(refusal(options), path + ": --spacing has 0; each must be finite and above 0");
  options.spacing = {1.0, 1.0, std::numeric_limits<double>::infinity()};
  EXPECT_EQ(refusal(options), path + ": --spacing has inf; each must be finite and above 0");
  options.spacing = {1, 1e-200, 1};
  EXPECT_EQ(refusal(options), path + ": --spacing has 1e-200; each must be within 1e-37 and 1e+37");
  options.spacing = {1, 1, 1e200};
  EXPECT_EQ(refusal(options), path + ": --spacing has 1e+200; each must be within 1e-37 and 1e+37");
  options.spacing.reset();
  options.origin = {0.0, std::nan(""), 0.0};
  EXPECT_EQ(refusal(options), path + ": --origin has nan; each must be finite");
  options.origin = {1e300, 0.0, 0.0};
  EXPECT_EQ(refusal(options), path + ": --origin has 1e+300; each must be within -1e+37 and 1e+37");
  options.origin = {0.0, 0.0, -2e37};
  EXPECT_EQ(refusal(options), path + ": --origin has -2e+37; each must be within -1e+37 and 1e+37");
}

// The far end of the volume lies beyond the greatest float32, 3.4e38, but its origin does not.
TEST(SourceView, VolumeThatReachesBeyondFloat32_IsRefused) {
  const Scratch scratch;
  SourceOptions options;
  options.spacing = {1, 1, 1e37};
  options.origin = {0, 0, 1e37};
  const auto opened = [&](const std::string& name, std::size_t bytes) {
    return place_source(open_raw(scratch.write(name, std::vector<std::byte>(bytes)), options), options);
  };
  EXPECT_EQ(opened("v_1x1x30_uint8.raw", 30)->info().origin, *options.origin);
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { opened("v_1x1x35_uint8.raw", 35); }),
            scratch.path("v_1x1x35_uint8.raw") +
                ": reaches 3.6e+38 along z with 35 voxels 1e+37 apart, and float32 does not hold that; give a smaller "
                "--spacing");
}

}  // namespace
}  // namespace weir::source_view_test
