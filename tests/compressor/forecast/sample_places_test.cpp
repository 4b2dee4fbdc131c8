#include "compressor/forecast/sample_places.h"

#include <gtest/gtest.h>

#include <array>

#include "compressor/forecast/sampled_source.h"
#include "tests/compressor/support/memory_volume.h"

namespace weir::sample_places_test {
namespace {

using test::MemoryVolume;

// A value that tells its position.
float at(const Index3& i) { return static_cast<float>(i.x + 1000 * i.y + 1000000 * i.z); }

const Box kDomain{{-4, 3, 0}, {136, 140, 130}};

TEST(SamplePlaces, VoxelOfASample_LiesWhereItWasTaken) {
  MemoryVolume volume(kDomain, at);
  const SamplePlan plan(kDomain, {}, 140 * 40 * 40, 1);
  ASSERT_FALSE(plan.whole());
  SampledSource sample(volume, plan);
  ASSERT_NE(sample.places(), nullptr);
  EXPECT_EQ(sample.places()->origin_domain(), kDomain);
  const Box all = plan.domain();
  for (const Index3& voxel : {all.lo, all.lo + Index3{3, 9, 17}, all.hi - Index3{1, 1, 1}}) {
    std::array<float, 1> value{};
    sample.read({voxel, voxel + Index3{1, 1, 1}}, value);
    EXPECT_EQ(at(sample.places()->origin_of(voxel)), value[0]);
    EXPECT_TRUE(sample.places()->cell(voxel).contains(voxel));
    EXPECT_EQ(sample.places()->reach(voxel), nullptr) << "nothing was read around it";
  }
  // The same for a part, which is read from the sample.
  for (const SamplePlan& part : plan.parts()) {
    SampledSource of_sample(sample, part, SampledSource::From::copy);
    const Index3 voxel = part.domain().hi - Index3{2, 3, 4};
    std::array<float, 1> value{};
    of_sample.read({voxel, voxel + Index3{1, 1, 1}}, value);
    EXPECT_EQ(at(of_sample.places()->origin_of(voxel)), value[0]);
    EXPECT_EQ(of_sample.places()->origin_domain(), kDomain);
  }
}

TEST(SamplePlaces, ReachOfALeaf_IsThatInTheVolume) {
  MemoryVolume volume(kDomain, at);
  const SamplePlan plan(kDomain, {}, 140 * 40 * 40, 1);
  SampledSource sample(volume, plan);
  sample.find_reaches(nullptr);
  const auto expect_reach = [&](const SamplePlan& of, const SampledSource& source) {
    const NodeLattice leaves = make_lattice(of.domain(), kLeafDim);
    for (std::int64_t i = 0; i < leaves.size(); ++i) {
      const Box leaf = leaves.voxels(leaves.position(i));
      const Index3 lo = source.places()->origin_of(leaf.lo);
      const Box around = intersect(grown({lo, lo + leaf.extent()}, 1), kDomain);
      const MinMax* const reach = source.places()->reach(leaf.lo);
      ASSERT_NE(reach, nullptr);
      EXPECT_EQ(reach->min, at(around.lo));
      EXPECT_EQ(reach->max, at(around.hi - Index3{1, 1, 1}));
    }
  };
  expect_reach(plan, sample);
  const SamplePlan part = plan.parts().back();
  expect_reach(part, SampledSource(sample, part, SampledSource::From::copy));
}

TEST(SamplePlaces, WholeVolume_HasNone) {
  MemoryVolume volume(kDomain, at);
  const SamplePlan plan(kDomain, {}, 1 << 24U, 1);
  EXPECT_EQ(SampledSource(volume, plan).places(), nullptr);
}

}  // namespace
}  // namespace weir::sample_places_test
