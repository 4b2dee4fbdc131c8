// The device surveys and encodes packed blocks to the bits that the host gives.
#include "gpu/cuda/encode/device_coder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "format/packed/block_decode.h"
#include "format/packed/block_encode.h"
#include "tests/cuda/support/device_reads.h"
#include "tests/support/block_volumes.h"

namespace weir::device_coder_test {
namespace {

using Values = std::array<float, 512>;

// The blocks of a volume, whose first one begins 5, 0 and 3 voxels before it where the volume is larger than one.
struct Blocks {
  const test::BlockVolume& volume;
  Box voxels;
  Box blocks;

  explicit Blocks(const test::BlockVolume& of)
      : volume(of), voxels{{8, 8, 8}, Index3{8, 8, 8} + of.extent}, blocks{{8, 8, 8}, {}} {
    if (of.extent.x > 1) voxels = {voxels.lo + Index3{5, 0, 3}, voxels.hi + Index3{5, 0, 3}};
    blocks.hi = Index3{ceil_div(voxels.hi.x, 8), ceil_div(voxels.hi.y, 8), ceil_div(voxels.hi.z, 8)} * 8;
  }
  Index3 count() const { return {blocks.extent().x / 8, blocks.extent().y / 8, blocks.extent().z / 8}; }
  Values of(std::int64_t b) const {
    const Index3 corner = blocks.lo + index_at(b, count()) * 8;
    Values values;
    for (std::int64_t i = 0; i < 512; ++i) {
      const Index3 voxel = max(voxels.lo, min(voxels.hi - Index3{1, 1, 1}, corner + Index3{i >> 6, i >> 3 & 7, i & 7}));
      values[static_cast<std::size_t>(i)] =
          volume.values[static_cast<std::size_t>(linear_index(voxel - voxels.lo, volume.extent))];
    }
    return values;
  }
};

bool all_finite(const Values& values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

void expect_no_failure(const Error& error) { ADD_FAILURE() << error.what(); }

TEST(DeviceCoder, FiguresAndCostsAreThoseOfTheHost) {
  WEIR_NEEDS_DEVICE();
  const auto coder = make_device_coder(0, expect_no_failure);
  TransformBlock transform;
  std::size_t compared = 0;
  for (const test::BlockVolume& volume : test::block_volumes()) {
    SCOPED_TRACE(volume.name);
    const Blocks blocks(volume);
    for (const RungAsk& ask : {RungAsk{}, RungAsk{false, 6}}) {
      const auto loaded = coder->load(volume.values, blocks.voxels, blocks.blocks);
      ASSERT_NE(loaded, nullptr);
      loaded->begin_survey(ask);
      const auto surveyed = loaded->end_survey();
      ASSERT_TRUE(surveyed);
      for (std::int64_t b = 0; b < weir::volume(blocks.count()); ++b) {
        const Values values = blocks.of(b);
        if (!all_finite(values)) continue;
        const BlockFigures& figures = surveyed->figures[static_cast<std::size_t>(b)];
        ASSERT_EQ(figures.transformed != 0, transform.set(values)) << b;
        if (figures.transformed == 0 || figures.lattice != 0) continue;
        ASSERT_EQ(figures.mean, transform.mean()) << b;
        ASSERT_EQ(figures.energy, transform.energy()) << b;
        for (std::uint32_t k = 0; k < figures.rungs; ++k) {
          const RungCost& cost = surveyed->costs[ask.most() * static_cast<std::size_t>(b) + k];
          if (cost.bits == 0) continue;
          const auto expected =
              transform.cost(rung_step(figures.first_step, figures.first_rung + static_cast<std::int32_t>(k)));
          ASSERT_EQ(cost.bits, expected.bits) << b << ", " << k;
          ASSERT_EQ(cost.squared_error, expected.squared_error) << b << ", " << k;
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 5000U);
}

TEST(DeviceCoder, StreamsAndDecodedValuesAreThoseOfTheHost) {
  WEIR_NEEDS_DEVICE();
  const auto coder = make_device_coder(0, expect_no_failure);
  TransformBlock transform;
  std::size_t compared = 0;
  for (const test::BlockVolume& volume : test::block_volumes()) {
    SCOPED_TRACE(volume.name);
    const Blocks blocks(volume);
    BlockConstants constants;
    constants.minimum = *std::min_element(volume.values.begin(), volume.values.end());
    constants.maximum = *std::max_element(volume.values.begin(), volume.values.end());
    constants.below_one = kBelowOne;
    constants.below_more = kBelowMore;
    constants.tables = built_in_tables();
    const auto loaded = coder->load(volume.values, blocks.voxels, blocks.blocks);
    ASSERT_NE(loaded, nullptr);
    for (std::int32_t rung = 1; rung < kLadderRungs; rung += 2) {
      std::vector<StreamAsk> asks;
      std::uint32_t offset = 0;
      std::int32_t coarsest = kMostStep;
      for (std::int64_t b = 0; b < weir::volume(blocks.count()); ++b) {
        const Values values = blocks.of(b);
        if (!all_finite(values) || !transform.set(values) || !(transform.largest() > 0)) continue;
        const std::int32_t step = rung_step(first_rung_step(transform.largest()), rung);
        const MeanRange means{transform.mean(),
                              transform.mean() * 1.001F + 1e-3F * static_cast<float>(transform.largest())};
        if (step < kLeastStep || step > kMostStep || means.high < means.low) continue;
        const unsigned bits = mean_bits(means, step);
        const TransformBlock::Cost cost = transform.cost(step);
        if (bits == kNoMeanBits || cost.bits > 20000) continue;
        const auto bytes = static_cast<std::uint16_t>(stream_bytes(cost.bits, bits));
        asks.push_back({means, static_cast<std::uint32_t>(b), offset, bytes, static_cast<std::int16_t>(step)});
        offset += bytes;
        coarsest = std::min(coarsest, step);
      }
      if (asks.empty()) continue;
      constants.coarsest = coarsest;
      std::erase_if(asks, [&](const StreamAsk& ask) { return ask.step > coarsest + 63; });
      const auto pending = loaded->encode(asks, constants);
      ASSERT_NE(pending, nullptr);
      const auto found = pending->wait();
      ASSERT_TRUE(found);
      for (std::size_t i = 0; i < asks.size(); ++i) {
        if (found->made[i] == 0) continue;
        const StreamAsk& ask = asks[i];
        transform.set(blocks.of(ask.block));
        std::vector<std::byte> stream(ask.bytes);
        Values decoded;
        transform.encode(constants, ask.means, ask.step, stream);
        ASSERT_TRUE(decode_block(constants, ask.means, stream.data(), ask.bytes, decoded.data()));
        ASSERT_EQ(std::memcmp(stream.data(), found->bytes.data() + ask.offset, ask.bytes), 0)
            << ask.block << ", " << rung;
        ASSERT_EQ(std::memcmp(decoded.data(), found->decoded.data() + 512 * i, sizeof decoded), 0)
            << ask.block << ", " << rung;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 3000U);
}

}  // namespace
}  // namespace weir::device_coder_test
