// Ladders built from what the pretended device finds about blocks: bit for bit those that the host builds from the
// values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "compressor/leaf/leaf_summary.h"
#include "compressor/packed/ladder_builder.h"
#include "format/base/error.h"
#include "gpu/cuda/encode/device_coder.h"
#include "tests/fake_cuda/fake_runtime.h"
#include "tests/support/block_volumes.h"

namespace weir::fake_coder_test {
namespace {

using test::BlockVolume;
using test::FakeRuntime;

// A smooth field with noise. Most of its blocks lie partly outside it.
BlockVolume wavy(const Index3& extent) {
  BlockVolume volume{"wavy", extent, {}};
  std::mt19937 random(3);
  std::uniform_real_distribution<float> noise(-0.01F, 0.01F);
  for (std::int64_t i = 0; i < weir::volume(extent); ++i) {
    const Index3 v = index_at(i, extent);
    volume.values.push_back(std::sin(0.2F * static_cast<float>(v.x)) * std::cos(0.17F * static_cast<float>(v.y)) +
                            0.1F * static_cast<float>(v.z) + noise(random));
  }
  return volume;
}

class FoundLadders : public testing::Test {
 protected:
  FoundLadders() {
    FakeRuntime::instance().reset();
    coder_ = make_device_coder(0, [](const Error& error) { ADD_FAILURE() << error.what(); });
  }
  ~FoundLadders() override {
    coder_.reset();
    FakeRuntime::instance().reset();
  }

  // Surveys the blocks with the rungs of `aim` and compares each ladder. Returns for how many blocks the survey was
  // enough.
  std::size_t compare(const LadderAim& aim, NearRungs near) { return compare(aim, near, aim.rung_ask()); }
  std::size_t compare(const LadderAim& aim, NearRungs near, const RungAsk& ask) {
    LadderBuilder builder(aim);
    std::size_t built = 0;
    looked_at_ = 0;
    for (const BlockVolume& volume : volumes_) {
      SCOPED_TRACE(volume.name);
      const Box voxels{{0, 0, 0}, volume.extent};
      const Index3 count{ceil_div(volume.extent.x, 8), ceil_div(volume.extent.y, 8), ceil_div(volume.extent.z, 8)};
      const auto loaded = coder_->load(volume.values, voxels, {{0, 0, 0}, count * 8});
      loaded->begin_survey(ask);
      const auto found = loaded->end_survey();
      for (const RungCost& cost : found->costs) looked_at_ += cost.bits != 0 ? 1 : 0;
      for (const NearCost& cost : found->near) looked_at_ += cost.bytes != 0 ? 1 : 0;
      for (std::int64_t b = 0; b < weir::volume(count); ++b) {
        LeafValues values;
        std::vector<float> inside;
        for (std::int64_t i = 0; i < 512; ++i) {
          const Index3 place = index_at(b, count) * 8 + Index3{i >> 6, i >> 3 & 7, i & 7};
          const Index3 voxel = min(voxels.hi - Index3{1, 1, 1}, place);
          const float value = volume.values[static_cast<std::size_t>(linear_index(voxel, volume.extent))];
          values[static_cast<std::size_t>(i)] = value;
          if (voxel == place) inside.push_back(value);
        }
        if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); })) continue;
        const LeafRow row = summarize_leaf(inside, 0);
        if (row.uniform()) continue;
        const auto ladder = builder.build_from(found->block(static_cast<std::size_t>(b)), row, near);
        if (!ladder) continue;
        ++built;
        const PackedLadder expected = builder.build(values, row, near);
        EXPECT_EQ(std::memcmp(&*ladder, &expected, sizeof expected), 0) << b;
      }
    }
    return built;
  }

  std::unique_ptr<BlockCoder> coder_;
  std::size_t looked_at_ = 0;  // rungs and near rungs of all blocks
  std::vector<BlockVolume> volumes_ = [] {
    std::vector<BlockVolume> all = test::block_volumes();
    for (BlockVolume& volume : test::mixed_volumes()) all.push_back(std::move(volume));
    for (const Index3& extent : {Index3{65, 66, 1}, Index3{64, 67, 10}}) all.push_back(wavy(extent));
    return all;
  }();
};

TEST_F(FoundLadders, WithNearRungsAreThoseOfTheHost_WhereverTheWindowLies) {
  LadderAim aim;
  aim.near_rungs = true;
  std::size_t built = 0;
  for (const NearBlocks near : {NearBlocks::sparse, NearBlocks::all}) {
    aim.near = near;
    for (const double centre : {1e-24, 1e-14, 1e-9, 1e-5, 1e-2, 10.0, 1e6}) {
      for (const float width : {0.0F, 1e30F}) {  // means have codes at all steps, or at none
        SCOPED_TRACE(testing::Message() << centre << ' ' << width);
        for (const double reach : {1.25, KeyWindow::kMostReach}) {
          aim.window = KeyWindow(centre, width, reach);
          built += compare(aim, NearRungs::yes);
        }
      }
    }
  }
  EXPECT_GT(built, 9600U);
}

TEST_F(FoundLadders, AreEnoughForAsManyBlocks_OfFewerRungs_WhereTheKeysAreKnown) {
  LadderAim aim;
  aim.near_rungs = true;
  aim.near = NearBlocks::all;
  std::size_t all = 0;
  std::size_t fewer = 0;
  for (const double centre : {1e-14, 1e-9, 1e-5, 1e-2, 10.0}) {
    for (const float width : {0.0F, 1e30F}) {
      SCOPED_TRACE(testing::Message() << centre << ' ' << width);
      aim.window = KeyWindow(centre, width, 1.25);
      RungAsk unknown = aim.rung_ask();
      unknown.keys = {};
      const std::size_t built = compare(aim, NearRungs::yes, unknown);
      all += looked_at_;
      EXPECT_EQ(compare(aim, NearRungs::yes), built);
      fewer += looked_at_;
    }
  }
  EXPECT_LT(fewer, all * 2 / 3);
}

TEST_F(FoundLadders, WithAllNearRungsAreThoseOfTheHost) {
  LadderAim aim;
  aim.near_rungs = true;
  aim.near = NearBlocks::all;
  EXPECT_GT(compare(aim, NearRungs::yes), 450U);
}

TEST_F(FoundLadders, WithoutNearRungsAreThoseOfTheHost_WhetherTheyWereAskedForOrNot) {
  LadderAim aim;
  for (const bool asked : {false, true}) {
    aim.near_rungs = asked;
    aim.near = NearBlocks::all;
    aim.window.reset();
    EXPECT_GT(compare(aim, NearRungs::no), 300U);
    aim.window = KeyWindow(1e-5, 1);
    EXPECT_GT(compare(aim, NearRungs::no), 300U);
  }
}

}  // namespace
}  // namespace weir::fake_coder_test
