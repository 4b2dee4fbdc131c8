#include "compressor/survey/block_survey.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

#include "tests/compressor/support/crash_file_system.h"
#include "tests/compressor/support/surveyed.h"

namespace weir::block_survey_test {
namespace {

using test::MemoryVolume;
using test::Surveyed;

// Three threads survey blocks in any order with two surveys. Their tallies are merged, as two processes do.
TEST(BlockSurvey, MergedBlockSurveysEqualTheWholeSurvey) {
  MemoryVolume volume({{-13, 5, 120}, {40, 60, 171}}, [](const Index3& i) {
    if (i == Index3{20, 50, 130} || i == Index3{19, 50, 150}) return NAN;
    return static_cast<float>((i.x * i.x + i.y * i.z) % 1000);
  });
  volume.info().type = ScalarType::int16;
  const Surveyed expected(volume);

  const BlockPlan plan = plan_blocks(volume.info().domain(), volume.access(), 20'000);
  std::vector<std::int64_t> order(static_cast<std::size_t>(plan.size()));
  ASSERT_GT(order.size(), 20U);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  RowStore rows(test::CrashFileSystem().create_unnamed("rows"), plan.lattice, {});
  LeafStore<LeafFaces> faces(test::CrashFileSystem().create_unnamed("faces"), plan.lattice);
  BlockSurvey first(volume.info(), rows, &faces, false, nullptr);
  BlockSurvey second(volume.info(), rows, &faces, false, nullptr);
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < 3; ++t) {
      threads.emplace_back([&, t] {
        for (std::size_t i = t; i < order.size(); i += 3) {
          const Box leaf_box = plan.leaf_box(order[i]);
          const Box voxels = plan.voxel_box(leaf_box);
          const std::vector<float> values = volume.in(voxels);
          const auto sharing = i % 2 == 0 ? BlockSurvey::Sharing::alone : BlockSurvey::Sharing::shared;
          (i % 5 == 0 ? first : second).add({i, voxels, values, {1, 2, static_cast<double>(i)}}, leaf_box, sharing);
        }
      });
    }
  }
  SurveyTally tally = first.tally();
  tally.merge(second.tally());
  const Survey survey = first.result(tally);

  EXPECT_EQ(survey.min, expected.survey.min);
  EXPECT_EQ(survey.max, expected.survey.max);
  EXPECT_EQ(survey.finite, expected.survey.finite);
  EXPECT_EQ(survey.non_finite, 2U);
  EXPECT_EQ(survey.first_non_finite, (Index3{20, 50, 130}));
  EXPECT_EQ(survey.value_counts, expected.survey.value_counts);
  EXPECT_EQ(survey.histogram.counts(), expected.survey.histogram.counts());
  EXPECT_EQ(survey.loss.inexact, order.size());
  EXPECT_EQ(survey.loss.overflow, 2 * order.size());
  EXPECT_EQ(survey.loss.max_abs_error, static_cast<double>(order.size() - 1));
  std::vector<LeafRow> all(static_cast<std::size_t>(plan.lattice.size()));
  rows.read(0, all);
  const std::vector<LeafRow> same = expected.all_rows();
  EXPECT_EQ(std::memcmp(all.data(), same.data(), all.size() * sizeof(LeafRow)), 0);
  std::vector<LeafFaces> of_last(1);
  faces.read(plan.lattice.size() - 1, of_last);
  const Box last = plan.lattice.voxels(plan.lattice.count - Index3{1, 1, 1});
  const LeafFaces seen = faces_of(volume.in(last), last.extent());
  EXPECT_EQ(std::memcmp(of_last.data(), &seen, sizeof seen), 0);
}

// The length of a vector of uint8 values is often no uint8, and may be larger than any uint8.
TEST(BlockSurvey, LengthsOfVectorsAreNotCountedAsValuesOfTheirType) {
  for (const ScalarType type : {ScalarType::uint8, ScalarType::int8, ScalarType::uint16, ScalarType::int16}) {
    MemoryVolume volume({{0, 0, 0}, {20, 16, 16}}, [](const Index3& i) {
      return static_cast<float>(std::sqrt(static_cast<double>(i.x * i.x + 90000 * (i.y % 2) * i.z * i.z)));
    });
    volume.info().type = type;
    volume.info().lengths = true;
    const Surveyed surveyed(volume);
    EXPECT_TRUE(surveyed.survey.value_counts.empty());
    EXPECT_EQ(surveyed.survey.max, static_cast<float>(std::sqrt(20250361.0)));
    std::uint64_t counted = 0;
    for (const std::uint64_t count : surveyed.survey.histogram.counts()) counted += count;
    EXPECT_EQ(counted, 20U * 16 * 16);
  }
}

}  // namespace
}  // namespace weir::block_survey_test
