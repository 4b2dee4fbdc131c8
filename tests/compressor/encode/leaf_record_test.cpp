#include "compressor/encode/leaf_record.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "tests/compressor/support/crash_file_system.h"

namespace weir::leaf_record_test {
namespace {

TEST(LeafRecord, OutwardLayersFaceOutOfTheMacrocell) {
  std::mt19937 random(12);
  for (const Index3& leaf : {Index3{0, 0, 0}, Index3{1, 0, 1}, Index3{-1, -2, 3}, Index3{5, 7, -3}}) {
    const Box node{leaf * 8, leaf * 8 + Index3{8, 8, 8}};
    for (const Box& inside :
         {node, Box{node.lo + Index3{0, 2, 0}, node.hi - Index3{1, 0, 0}}, Box{node.lo, node.lo + Index3{1, 1, 1}}}) {
      LeafValues values;
      for (float& v : values) v = static_cast<float>(random() % 10000) - 5000;
      const NodeStatistics statistics = leaf_statistics(values, node, inside);
      const LeafRecord record = make_leaf_record(values, node, inside, statistics);
      EXPECT_EQ(record.mean, statistics.mean);
      EXPECT_EQ(record.m2, statistics.m2);
      EXPECT_EQ(record.bounds.min, statistics.min);
      EXPECT_EQ(record.bounds.max, statistics.max);
      for (unsigned d = 1; d < 8; ++d) {
        // The voxels that lie at the macrocell's side along every axis that d names.
        MinMax expected = kNoBounds;
        for (std::int64_t n = 0; n < 512; ++n) {
          const Index3 i = node.lo + Index3{n >> 6, n >> 3 & 7, n & 7};
          const auto at_side = [](std::int64_t v) {
            return floor_div(v, 16) * 16 == v || floor_div(v + 1, 16) * 16 == v + 1;
          };
          const bool faces = (!(d & 1U) || at_side(i.x)) && (!(d & 2U) || at_side(i.y)) && (!(d & 4U) || at_side(i.z));
          if (!faces || !inside.contains(i)) continue;
          const float v = values[static_cast<std::size_t>(n)];
          widen(expected, {v, v});
        }
        EXPECT_EQ(record.outward[d - 1].min, expected.min) << d;
        EXPECT_EQ(record.outward[d - 1].max, expected.max) << d;
      }
    }
  }
}

TEST(LeafRecord, EmptyBoundsWidenToFiniteValuesOnly) {
  MinMax bounds = kNoBounds;
  widen(bounds, kNoBounds);
  EXPECT_GT(bounds.min, bounds.max);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  widen(bounds, {nan, nan});
  EXPECT_GT(bounds.min, bounds.max);
  widen(bounds, {3e38F, 3e38F});
  widen(bounds, {-3e38F, -3e38F});
  EXPECT_EQ(bounds.min, -3e38F);
  EXPECT_EQ(bounds.max, 3e38F);
}

TEST(RecordStore, GivesBackRecordsByOrdinal) {
  RecordStore store(test::CrashFileSystem().create_unnamed("records"), 10);
  std::vector<LeafRecord> records(3);
  for (std::size_t i = 0; i < records.size(); ++i) records[i].mean = static_cast<double>(i) + 0.5;
  store.write(7, records);
  const std::vector<LeafRecord> found = store.read(8, 2);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].mean, 1.5);
  EXPECT_EQ(found[1].mean, 2.5);
  EXPECT_TRUE(store.read(0, 0).empty());
}

}  // namespace
}  // namespace weir::leaf_record_test
