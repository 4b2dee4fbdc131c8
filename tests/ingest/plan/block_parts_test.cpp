#include "ingest/plan/block_parts.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "ingest/plan/block_stream.h"

namespace weir::block_parts_test {
namespace {

const Box kDomain{{-5, 3, 16}, {37, 40, 41}};

/// A source with one value for each 4 x 2 x 1 voxels where 0 <= x < kSplit and y >= 8. The other voxels each have a
/// value of their own.
class CoarseSource final : public VolumeSource {
 public:
  CoarseSource() {
    info_.extent = kDomain.extent();
    info_.index_origin = kDomain.lo;
  }
  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {4, {}, {}}; }
  ConversionLoss read(const Box& box, std::span<float> values) override {
    std::size_t at = 0;
    for_each_index(box, [&](const Index3& i) { values[at++] = value(i); });
    return {static_cast<std::uint64_t>(box.voxels()), 0, 0};
  }
  std::vector<RepeatedPart> repeated_parts(const Box& box) const override {
    const Box coarse = intersect(box, {{0, 8, 16}, {kSplit, 40, 41}});
    if (coarse.empty() || coarse.lo != Index3{0, 8, box.lo.z}) return {{box}};
    return {{coarse, kBy},
            {{box.lo, {coarse.lo.x, box.hi.y, box.hi.z}}},
            {{{coarse.lo.x, box.lo.y, box.lo.z}, {coarse.hi.x, coarse.lo.y, box.hi.z}}},
            {{{coarse.hi.x, box.lo.y, box.lo.z}, box.hi}}};
  }
  ConversionLoss read_repeated(const RepeatedPart& part, std::span<float> values) override {
    std::size_t at = 0;
    for_each_index({{0, 0, 0}, part.groups()}, [&](const Index3& group) {
      values[at++] = value(part.box.lo + Index3{group.x * part.by.x, group.y * part.by.y, group.z * part.by.z});
    });
    return {static_cast<std::uint64_t>(part.box.voxels()), 0, 0};
  }
  std::uint64_t bytes_read() const override { return 0; }

  static float value(const Index3& i) {
    const bool coarse = i.x >= 0 && i.x < kSplit && i.y >= 8;
    const Index3 cell = coarse ? Index3{i.x / kBy.x, i.y / kBy.y, i.z / kBy.z} : i + Index3{1000, 0, 0};
    return static_cast<float>(cell.x + 100 * cell.y + 10000 * cell.z);
  }

  static constexpr std::int64_t kSplit = 16;
  static constexpr Index3 kBy{4, 2, 1};

 private:
  SourceInfo info_;
};

TEST(BlockParts, LeavesHaveTheValuesOfTheirVoxels) {
  CoarseSource source;
  StreamOptions options;
  options.in_parts = true;
  const std::vector<Box> boxes{{{-5, 3, 16}, {37, 40, 24}}, {{-5, 3, 24}, {37, 40, 41}}};
  std::size_t repeated = 0;
  const ConversionLoss loss = stream_blocks(source, boxes, options, [&](const Block& block) {
    ASSERT_NE(block.parts, nullptr);
    const NodeLattice leaves = make_lattice(block.voxels, kLeafDim);
    for (std::int64_t i = 0; i < leaves.size(); ++i) {
      const Box leaf = leaves.voxels(leaves.position(i));
      std::array<float, kLeafVoxels> distinct{};
      std::array<float, kLeafVoxels> values{};
      const Index3 by = block.parts->gather(block.values, leaf, distinct);
      repeated += by == Index3{1, 1, 1} ? 0 : 1;
      repeat_values(distinct.data(), by, leaf.extent(), values.data());
      std::size_t at = 0;
      for_each_index(leaf, [&](const Index3& voxel) { ASSERT_EQ(values.at(at++), CoarseSource::value(voxel)); });
    }
  });
  EXPECT_EQ(loss.inexact, static_cast<std::uint64_t>(kDomain.voxels()));
  EXPECT_EQ(repeated, 2U * 4 * 4);
}

TEST(BlockParts, WithoutAskingForParts_BlocksHaveAllVoxels) {
  CoarseSource source;
  stream_blocks(source, std::vector<Box>{kDomain}, {}, [&](const Block& block) {
    EXPECT_EQ(block.parts, nullptr);
    EXPECT_EQ(block.values.back(), CoarseSource::value(kDomain.hi - Index3{1, 1, 1}));
  });
}

}  // namespace
}  // namespace weir::block_parts_test
