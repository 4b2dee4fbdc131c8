// The device's encoder of packed blocks, run on the host: its figures, costs, streams and decoded values are bit for
// bit those of TransformBlock and decode_block().
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "format/packed/block_decode.h"
#include "format/packed/block_encode.h"
#include "gpu/cuda/encode/stream_steps.h"
#include "tests/gpu/encode/boxed_volume.h"

namespace weir::encode_steps_test {
namespace {

using encode_detail::HostWarp;

using test::BlockVolume;
class EncodeSteps : public testing::Test {
 protected:
  EncodeSteps() { make_encoder_tables(built_in_tables(), costs_, codes_); }

  CostTables costs_;
  CodeTables codes_;
  TransformBlock transform_;
};

TEST_F(EncodeSteps, FiguresAndCostsOfAllRungsAreThoseOfTheCpu) {
  std::size_t looked_at = 0;
  for (const BlockVolume& volume : test::block_volumes()) {
    for (const Index3& before : kBefores) {
      SCOPED_TRACE(volume.name);
      const Boxed boxed(volume, before);
      SurveyCall call;
      call.box = boxed.box;
      std::vector<BlockFigures> figures(boxed.box.count());
      std::vector<RungCost> costs(figures.size() * call.ask.most());
      call.figures = figures.data();
      call.costs = costs.data();
      encode_detail::BlockStage stage;
      for (std::uint32_t b = 0; b < boxed.box.count(); ++b) {
        survey_block(HostWarp{}, call, costs_, b, stage);
        const Values values = boxed.block(b);
        if (!all_finite(values)) continue;
        const bool transformed = transform_.set(values);
        ASSERT_EQ(figures[b].transformed != 0, transformed) << b;
        if (!transformed || figures[b].lattice != 0) continue;
        ASSERT_EQ(std::bit_cast<std::uint32_t>(figures[b].mean), std::bit_cast<std::uint32_t>(transform_.mean())) << b;
        ASSERT_EQ(static_cast<double>(figures[b].largest), transform_.largest()) << b;
        ASSERT_EQ(figures[b].energy, transform_.energy()) << b;
        for (std::uint32_t k = 0; k < figures[b].rungs; ++k) {
          const RungCost& cost = costs[call.ask.most() * b + k];
          const std::int32_t step =
              rung_step(figures[b].first_step, figures[b].first_rung + static_cast<std::int32_t>(k));
          if (cost.bits == 0) continue;
          const TransformBlock::Cost expected = transform_.cost(step);
          ASSERT_EQ(cost.bits, expected.bits) << b << " at step " << step;
          ASSERT_EQ(cost.squared_error, expected.squared_error) << b << " at step " << step;
          ++looked_at;
        }
      }
    }
  }
  EXPECT_GT(looked_at, 10000U);
}

TEST_F(EncodeSteps, RungsAboutAStepAreThoseAmongAll) {
  for (const BlockVolume& volume : test::block_volumes()) {
    SCOPED_TRACE(volume.name);
    const Boxed boxed(volume, {0, 0, 0});
    SurveyCall call;
    call.box = boxed.box;
    encode_detail::BlockStage stage;
    for (const std::int32_t wanted : {-200, -10, 0, 6, 13, 40, 200}) {
      call.ask = {false, wanted};
      std::vector<BlockFigures> figures(boxed.box.count());
      std::vector<RungCost> costs(figures.size() * call.ask.most());
      call.figures = figures.data();
      call.costs = costs.data();
      for (std::uint32_t b = 0; b < boxed.box.count(); b += 5) {
        survey_block(HostWarp{}, call, costs_, b, stage);
        if (figures[b].rungs == 0) continue;
        const std::int32_t start = rung_about(figures[b].first_step, wanted);
        EXPECT_LE(figures[b].first_rung, start);
        EXPECT_GT(figures[b].first_rung + 8, start);
        transform_.set(boxed.block(b));
        for (std::uint32_t k = 0; k < call.ask.most(); ++k) {
          const RungCost& cost = costs[call.ask.most() * b + k];
          const std::int32_t step =
              rung_step(figures[b].first_step, figures[b].first_rung + static_cast<std::int32_t>(k));
          if (cost.bits == 0) continue;
          ASSERT_EQ(cost.bits, transform_.cost(step).bits) << b << " at step " << step;
        }
      }
    }
  }
}

TEST_F(EncodeSteps, LatticesAreSeen) {
  std::size_t others = 0;
  for (const BlockVolume& volume : test::block_volumes()) {
    SCOPED_TRACE(volume.name);
    const Boxed boxed(volume, {0, 0, 0});
    encode_detail::BlockStage stage;
    for (std::uint32_t b = 0; b < boxed.box.count(); ++b) {
      encode_detail::gather_block(HostWarp{}, boxed.box, b, stage.values);
      const auto range = encode_detail::range_of_block(HostWarp{}, stage.values);
      const bool seen = encode_detail::may_lie_on_lattice(HostWarp{}, range, stage.values);
      if (volume.name == "whole numbers" || volume.name == "checkerboard") {
        EXPECT_TRUE(seen || range.low == range.high) << b;
      }
      if (volume.name == "cloud" || volume.name == "turbulence" || volume.name == "above one") {
        EXPECT_FALSE(seen) << b;
        ++others;
      }
    }
  }
  EXPECT_GT(others, 50U);
}

// The CPU's result for a block in a given number of bytes.
struct Expected {
  std::vector<std::byte> stream;
  Values decoded;
};

Expected expected_of(TransformBlock& transform, const BlockConstants& constants, const MeanRange& means,
                     std::int32_t step, std::uint32_t bytes) {
  Expected expected{std::vector<std::byte>(bytes), {}};
  transform.encode(constants, means, step, expected.stream);
  EXPECT_TRUE(decode_block(constants, means, expected.stream.data(), bytes, expected.decoded.data()));
  return expected;
}

TEST_F(EncodeSteps, StreamsAndWhatTheyDecodeToAreThoseOfTheCpu) {
  std::size_t made = 0;
  std::size_t left = 0;
  std::size_t means_alone = 0;
  for (const BlockVolume& volume : test::block_volumes()) {
    SCOPED_TRACE(volume.name);
    const Boxed boxed(volume, volume.extent.x > 1 ? kBefores[1] : kBefores[0]);
    float low = std::numeric_limits<float>::max();
    float high = std::numeric_limits<float>::lowest();
    for (const float v : volume.values) {
      if (!std::isfinite(v)) continue;
      low = std::min(low, v);
      high = std::max(high, v);
    }
    EncodeCall call;
    call.box = boxed.box;
    call.constants.minimum = low;
    call.constants.maximum = high;
    call.constants.below_one = kBelowOne;
    call.constants.below_more = kBelowMore;
    call.constants.tables = built_in_tables();
    call.tables = &costs_;
    call.codes = &codes_;
    for (std::uint32_t b = 0; b < boxed.box.count(); b += 2) {
      const Values values = boxed.block(b);
      if (!all_finite(values) || !transform_.set(values) || !(transform_.largest() > 0)) continue;
      const std::int32_t first = first_rung_step(transform_.largest());
      for (std::int32_t rung = 1; rung < kLadderRungs; ++rung) {
        const std::int32_t step = rung_step(first, rung);
        if (step < kLeastStep || step > kMostStep) continue;
        call.constants.coarsest = std::max(step - 20, kLeastStep);
        const float spread = std::max(static_cast<float>(transform_.largest()) * 0.1F, std::fabs(low) * 1e-6F);
        const MeanRange means{transform_.mean() - spread, transform_.mean() + 2 * spread};
        const unsigned bits = mean_bits(means, step);
        const TransformBlock::Cost cost = transform_.cost(step);
        if (bits == kNoMeanBits || cost.bits > 20000) continue;
        const std::uint32_t usual = stream_bytes(cost.bits, bits);
        // Exactly the promised bytes, more, and less; with less, the CPU drops coefficients.
        for (const std::uint32_t bytes : {usual, usual + 1, usual + 37, usual - 1}) {
          if (bytes < 3) continue;
          StreamAsk ask{means, b, 0, static_cast<std::uint16_t>(bytes), static_cast<std::int16_t>(step)};
          StreamState state{};
          std::vector<encode_detail::Quad> coded(128);
          std::vector<std::uint16_t> words(bytes / 2 + 2, 0xABCD);
          std::vector<float> decoded(512);
          std::vector<std::byte> out(bytes + 1, std::byte{0x5A});
          std::uint8_t is_made = 2;
          call.asks = &ask;
          call.count = 1;
          call.states = &state;
          call.coded = coded.data()->of;
          call.words = words.data();
          call.decoded = decoded.data();
          call.out = out.data();
          call.made = &is_made;
          encode_detail::CodeStage stage;
          code_block(HostWarp{}, call, costs_, 0, stage);
          put_words(call, codes_.transform, 0);
          put_bytes(HostWarp{}, call, 0);
          EXPECT_EQ(words[bytes / 2], 0xABCD) << "beyond the room for words";
          EXPECT_EQ(out[bytes], std::byte{0x5A}) << "beyond the stream";
          const Expected expected = expected_of(transform_, call.constants, means, step, bytes);
          if (is_made == 0) {
            left += bytes < usual ? 0 : 1;
            continue;
          }
          ASSERT_EQ(is_made, 1);
          out.pop_back();
          ASSERT_EQ(out, expected.stream) << b << " at step " << step << " in " << bytes;
          ASSERT_EQ(std::memcmp(decoded.data(), expected.decoded.data(), sizeof expected.decoded), 0)
              << b << " at step " << step << " in " << bytes;
          ++made;
          means_alone += state.end == 0 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(made, 10000U);
  EXPECT_GT(means_alone, 100U);
  EXPECT_LT(left, made / 200) << "in as many bytes as was promised";
}

}  // namespace
}  // namespace weir::encode_steps_test
