// The device's survey of near rungs, run on the host: predictors, costs and errors are bit for bit those of
// RoundedBlock.
#include "gpu/cuda/encode/near_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "format/packed/lattice_block.h"
#include "format/packed/rounded_block.h"
#include "gpu/cuda/encode/survey_steps.h"
#include "tests/gpu/encode/boxed_volume.h"

namespace weir::encode_steps_test {
namespace {

using encode_detail::HostWarp;
using test::BlockVolume;

std::vector<BlockVolume> volumes() {
  std::vector<BlockVolume> all = test::block_volumes();
  for (BlockVolume& volume : test::mixed_volumes()) all.push_back(std::move(volume));
  return all;
}

class NearSteps : public testing::Test {
 protected:
  NearSteps() { make_encoder_tables(built_in_tables(), tables_, codes_); }

  // What the survey and then the near rungs' steps find for a volume's blocks.
  struct Found {
    std::vector<BlockFigures> figures;
    std::vector<NearCost> costs;
  };
  Found find(const BlockBox& box, const NearAsk& ask) const {
    Found found{std::vector<BlockFigures>(box.count()), std::vector<NearCost>(box.count() * ask.most())};
    std::vector<RungCost> rungs(box.count() * RungAsk{}.most());
    SurveyCall survey;
    survey.box = box;
    survey.figures = found.figures.data();
    survey.costs = rungs.data();
    NearCall call{box, &tables_, &codes_, {true, 0, ask}, found.figures.data(), rungs.data(), found.costs.data()};
    encode_detail::BlockStage stage;
    encode_detail::LatticeStage near_stage;
    for (std::uint32_t b = 0; b < box.count(); ++b) {
      survey_block(HostWarp{}, survey, tables_, b, stage);
      survey_near_rungs(HostWarp{}, call, tables_, b, near_stage);
    }
    return found;
  }

  CostTables tables_;
  CodeTables codes_;
  RoundedBlock rounded_;
};

TEST_F(NearSteps, CostsAndErrorsOfAllNearRungsAreThoseOfTheCpu) {
  std::size_t rungs = 0;
  std::size_t none = 0;
  for (const BlockVolume& volume : volumes()) {
    SCOPED_TRACE(volume.name);
    for (const Index3& before : kBefores) {
      const Boxed boxed(volume, before);
      const NearAsk ask{NearBlocks::all};
      const Found found = find(boxed.box, ask);
      for (std::uint32_t b = 0; b < boxed.box.count(); ++b) {
        const Values values = boxed.block(b);
        const BlockFigures& figures = found.figures[b];
        if (!all_finite(values) || figures.transformed == 0 || figures.lattice != 0 || !(figures.energy > 0)) {
          ASSERT_EQ(figures.near, 0) << b;
          continue;
        }
        ASSERT_EQ(figures.first_near, 0) << b;
        ASSERT_EQ(figures.near, kNearRungs) << b;
        rounded_.set(values);
        const std::int32_t coarsest = coarsest_near_exponent(rounded_.exponent());
        for (std::int32_t rung = 0; rung < kNearRungs; ++rung) {
          const NearCost& cost = found.costs[ask.most() * b + static_cast<std::uint32_t>(rung)];
          const auto expected = rounded_.cost(coarsest - rung);
          ASSERT_EQ(cost.bytes, expected ? expected->bytes : kNoNearBytes) << b << ", rung " << rung;
          ASSERT_EQ(cost.squared_error, expected ? expected->squared_error : 0) << b << ", rung " << rung;
          ++(expected ? rungs : none);
        }
      }
    }
  }
  EXPECT_GT(rungs, 4000U);
  EXPECT_GT(none, 100U);
}

TEST_F(NearSteps, NearRungsAboutAQuantumAreThoseAmongAll) {
  for (const BlockVolume& volume : volumes()) {
    SCOPED_TRACE(volume.name);
    const Boxed boxed(volume, {0, 0, 0});
    const Found all = find(boxed.box, {NearBlocks::all});
    for (const std::int32_t wanted : {-200, -30, -9, -4, 3, 90}) {
      const NearAsk ask{NearBlocks::all, false, wanted};
      const Found about = find(boxed.box, ask);
      for (std::uint32_t b = 0; b < boxed.box.count(); ++b) {
        const BlockFigures& figures = about.figures[b];
        ASSERT_EQ(figures.near != 0, all.figures[b].near != 0) << b;
        if (figures.near == 0) continue;
        ASSERT_EQ(figures.near, NearAsk::kAbout);
        rounded_.set(boxed.block(b));
        const std::int32_t start = near_rung_about(coarsest_near_exponent(rounded_.exponent()), wanted);
        ASSERT_LE(figures.first_near, start);
        ASSERT_GT(figures.first_near + figures.near, start);
        for (std::uint32_t k = 0; k < figures.near; ++k) {
          const NearCost& cost = about.costs[ask.most() * b + k];
          const NearCost& same = all.costs[std::uint32_t{kNearRungs} * b + figures.first_near + k];
          ASSERT_EQ(cost.bytes, same.bytes) << b << ", " << k;
          ASSERT_EQ(cost.squared_error, same.squared_error) << b << ", " << k;
        }
      }
    }
  }
}

TEST_F(NearSteps, FloatsInOrderTakeTheBytesThatTheCpuTakes) {
  const ValueEncoder coder(built_in_tables(), ValueEncoder::Kind::lattice);
  BlockConstants constants;
  constants.tables = built_in_tables();
  std::size_t shorter = 0;
  std::size_t raw = 0;
  for (const BlockVolume& volume : volumes()) {
    SCOPED_TRACE(volume.name);
    for (const Index3& before : kBefores) {
      const Boxed boxed(volume, before);
      const Found found = find(boxed.box, {NearBlocks::all});
      for (std::uint32_t b = 0; b < boxed.box.count(); ++b) {
        if (found.figures[b].near == 0) continue;
        std::array<std::byte, 4096> out;
        const std::uint32_t bytes = encode_exact(coder, constants, std::nullopt, boxed.block(b), out);
        ASSERT_EQ(found.figures[b].ordered_bytes, bytes) << b;
        ++(bytes < kRawStreamBytes ? shorter : raw);
      }
    }
  }
  EXPECT_GT(shorter, 500U);
  EXPECT_GT(raw, 10U);
}

TEST_F(NearSteps, FloatsInOrderOfAWindowAreThoseOfSparseBlocks) {
  for (const BlockVolume& volume : volumes()) {
    SCOPED_TRACE(volume.name);
    const Boxed boxed(volume, {0, 0, 0});
    const Found all = find(boxed.box, {NearBlocks::all});
    const Found found = find(boxed.box, {NearBlocks::all, false, -9});
    for (std::uint32_t b = 0; b < boxed.box.count(); ++b) {
      const Values values = boxed.block(b);
      const bool is_sparse = 2 * std::count(values.begin(), values.end(), 0.0F) > 512;
      ASSERT_EQ(found.figures[b].ordered_bytes, is_sparse ? all.figures[b].ordered_bytes : 0) << b;
    }
  }
}

TEST_F(NearSteps, BlocksWithFewZerosHaveNoneWhereSparseOnesAreAsked) {
  std::size_t sparse = 0;
  std::size_t others = 0;
  for (const BlockVolume& volume : volumes()) {
    SCOPED_TRACE(volume.name);
    const Boxed boxed(volume, {0, 0, 0});
    const Found all = find(boxed.box, {NearBlocks::all});
    const Found found = find(boxed.box, {NearBlocks::sparse});
    for (std::uint32_t b = 0; b < boxed.box.count(); ++b) {
      if (all.figures[b].near == 0) continue;
      const Values values = boxed.block(b);
      const bool is_sparse = 2 * std::count(values.begin(), values.end(), 0.0F) > 512;
      ASSERT_EQ(found.figures[b].near, is_sparse ? kNearRungs : 0) << b;
      ++(is_sparse ? sparse : others);
    }
  }
  EXPECT_GT(sparse, 20U);
  EXPECT_GT(others, 200U);
}

}  // namespace
}  // namespace weir::encode_steps_test
