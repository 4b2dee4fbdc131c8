#include "compressor/forecast/sample_plan.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

namespace weir::sample_plan_test {
namespace {

std::set<std::tuple<std::int64_t, std::int64_t, std::int64_t>> corners(const SamplePlan& plan) {
  std::set<std::tuple<std::int64_t, std::int64_t, std::int64_t>> all;
  for_each_index({{}, plan.counts()}, [&](const Index3& place) {
    const Index3 at = plan.source_corner(place);
    all.emplace(at.x, at.y, at.z);
  });
  return all;
}

TEST(SamplePlan, SmallVolume_IsTakenWhole) {
  const Box domain{{-3, 0, 5}, {100, 90, 70}};
  const SamplePlan plan(domain, {}, domain.voxels(), 1);
  EXPECT_TRUE(plan.whole());
  EXPECT_EQ(plan.domain(), domain);
  EXPECT_EQ(plan.places(), 1);
  EXPECT_EQ(plan.source_corner({0, 0, 0}), domain.lo);
  EXPECT_TRUE(plan.parts().empty());
}

TEST(SamplePlan, LargeVolume_IsSampledByRowsInWholeLowerNodes) {
  const Box domain{{0, 0, 0}, {1024, 1024, 1024}};
  const SamplePlan plan(domain, {}, std::int64_t{64} << 20U, 1);
  EXPECT_EQ(plan.domain(), (Box{{0, 0, 0}, {1024, 256, 256}}));
  EXPECT_EQ(plan.places(), 32 * 32);
  EXPECT_EQ(plan.cell(), (Index3{1024, 8, 8}));
}

TEST(SamplePlan, Places_AreSpreadEvenly) {
  const Box domain{{0, 0, 0}, {1024, 1024, 1024}};
  const SamplePlan plan(domain, {}, std::int64_t{64} << 20U, 1);
  // Each square of 32 x 32 voxels in y and z has one of the 32 x 32 places.
  for_each_index({{}, plan.counts()}, [&](const Index3& place) {
    const Index3 at = plan.source_corner(place);
    EXPECT_EQ(at.y / 32, place.y);
    EXPECT_EQ(at.z / 32, place.z);
  });
  EXPECT_EQ(corners(plan).size(), 1024U);
}

TEST(SamplePlan, Parts_ShareOutThePlacesOfTheSample) {
  const SamplePlan plan({{0, 0, 0}, {1024, 1024, 1024}}, {}, std::int64_t{64} << 20U, 1);
  const std::vector<SamplePlan> parts = plan.parts();
  ASSERT_EQ(parts.size(), 8U);
  std::set<std::tuple<std::int64_t, std::int64_t, std::int64_t>> all;
  for (const SamplePlan& part : parts) {
    EXPECT_EQ(part.places(), plan.places() / 8);
    EXPECT_EQ(part.domain().voxels(), plan.domain().voxels() / 8);
    all.merge(corners(part));
  }
  EXPECT_EQ(all, corners(plan));
}

TEST(SamplePlan, LargeChunks_MayComeToATwentieth) {
  const Box domain{{0, 0, 0}, {512, 512, 4096}};
  const AccessShape slabs{4, {512, 512, 1}, {}};
  const SamplePlan plan(domain, slabs, 4 << 20U, 1);  // two layers of leaves
  EXPECT_EQ(plan.cell(), (Index3{512, 512, 8}));
  EXPECT_EQ(plan.places(), 16);
  EXPECT_LE(plan.domain().voxels(), domain.voxels() / 20);
  EXPECT_EQ(plan.access(slabs).chunk, (Index3{512, 512, 8}));
}

TEST(SamplePlan, Chunks_AreTheCells) {
  const AccessShape cubes{2, {64, 64, 64}, {}};
  const SamplePlan plan({{0, 0, 0}, {1000, 1000, 1000}}, cubes, 64 << 20U, 1);
  EXPECT_EQ(plan.cell(), (Index3{64, 64, 64}));
  EXPECT_GE(plan.places(), SamplePlan::kLeastPlaces);
  for_each_index({{}, plan.counts()}, [&](const Index3& place) {
    const Index3 at = plan.source_corner(place);
    EXPECT_EQ(at.x % 64 + at.y % 64 + at.z % 64, 0);
  });
}

TEST(SamplePlan, Bricks_AreNotCut) {
  const SamplePlan plan({{0, 0, 0}, {1000, 1000, 1000}}, {}, 8 << 20U, 4);
  EXPECT_EQ(plan.cell().y, 32);
  EXPECT_EQ(plan.cell().z, 32);
  for_each_index({{}, plan.counts()}, [&](const Index3& place) {
    const Index3 at = plan.source_corner(place);
    EXPECT_EQ(at.x % 32 + at.y % 32 + at.z % 32, 0);
  });
}

}  // namespace
}  // namespace weir::sample_plan_test
