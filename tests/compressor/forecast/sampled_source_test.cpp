#include "compressor/forecast/sampled_source.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/compressor/support/memory_volume.h"

namespace weir::sampled_source_test {
namespace {

using test::MemoryVolume;

float at(const Index3& i) { return static_cast<float>(i.x + 1000 * i.y + 1000000 * i.z); }

// Returns the values that the sample must hold in `box` according to its plan.
std::vector<float> expected(const SamplePlan& plan, const Box& box) {
  std::vector<float> values;
  for_each_index(box, [&](const Index3& i) {
    const Index3 in = i - plan.domain().lo;
    const Index3 cell = plan.cell();
    const Index3 place{in.x / cell.x, in.y / cell.y, in.z / cell.z};
    values.push_back(at(plan.source_corner(place) + (i - plan.box(place).lo)));
  });
  return values;
}

TEST(SampledSource, ReadsThePlacesOfItsPlan) {
  MemoryVolume volume({{-4, 3, 0}, {136, 140, 130}}, at);
  const SamplePlan plan(volume.info().domain(), {}, 140 * 40 * 40, 1);
  ASSERT_FALSE(plan.whole());
  SampledSource source(volume, plan);
  EXPECT_EQ(source.info().domain(), plan.domain());
  const Box all = source.info().domain();
  const Box middle{all.lo + Index3{5, 3, 2}, all.hi - Index3{1, 2, 7}};
  for (const Box& box : {all, middle}) {
    std::vector<float> values(static_cast<std::size_t>(box.voxels()));
    source.read(box, values);
    EXPECT_EQ(values, expected(plan, box));
    values.assign(values.size(), -1);
    source.read_alone(box, values);
    EXPECT_EQ(values, expected(plan, box));
  }
  EXPECT_EQ(source.voxels_read(), 2 * (all.voxels() + middle.voxels()));
  EXPECT_EQ(source.bytes_read(), static_cast<std::uint64_t>(source.voxels_read()) * sizeof(float));
}

TEST(SampledSource, OfAWholeVolume_IsTheVolume) {
  MemoryVolume volume({{1, 2, 3}, {40, 50, 60}}, at);
  const SamplePlan plan(volume.info().domain(), {}, 1 << 20U, 1);
  SampledSource source(volume, plan);
  const Box domain = volume.info().domain();
  std::vector<float> values(static_cast<std::size_t>(domain.voxels()));
  source.read(domain, values);
  EXPECT_EQ(values, volume.in(domain));
  EXPECT_EQ(source.working_bytes(), volume.working_bytes());
}

TEST(SampledSource, FindsTheRegionsThatVary) {
  // Of the eight regions, those with x >= 128 and z < 128 vary.
  MemoryVolume volume({{0, 0, 0}, {256, 256, 256}},
                      [](const Index3& i) { return i.x >= 128 && i.z < 128 ? at(i) : -1.0F; });
  const SamplePlan plan(volume.info().domain(), {}, 256 * 128 * 128, 1);
  SampledSource source(volume, plan);
  const Box all = source.info().domain();
  ASSERT_EQ(all.extent(), (Index3{256, 128, 128}));
  std::vector<float> values(static_cast<std::size_t>(all.voxels()));
  source.read(all, values);
  EXPECT_EQ(source.varied_in_volume(), 2U);
  EXPECT_EQ(source.varied_in_sample(), 1U);
  EXPECT_EQ(source.varied_share(), 0.5);  // each row goes through both halves of x
}

TEST(SampledSource, OfLargeChunks_ReadsOneAfterTheOther) {
  MemoryVolume volume({{0, 0, 0}, {96, 96, 384}}, at);
  volume.set_access({4, {96, 96, 48}, {}});
  const SamplePlan plan(volume.info().domain(), volume.access(), 96 * 96 * 100, 1);
  ASSERT_EQ(plan.cell(), (Index3{96, 96, 48}));
  SampledSource source(volume, plan);
  EXPECT_EQ(source.access().chunk, plan.cell());
  EXPECT_EQ(source.working_bytes(), 96U * 96 * 48 * sizeof(float));
  const Box box{{8, 0, 40}, {96, 96, plan.domain().hi.z}};
  std::vector<float> values(static_cast<std::size_t>(box.voxels()));
  source.read(box, values);
  EXPECT_EQ(values, expected(plan, box));
}

}  // namespace
}  // namespace weir::sampled_source_test
