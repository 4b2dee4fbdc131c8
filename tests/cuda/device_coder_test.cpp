// The device surveys and encodes packed blocks to exactly the bits that the host gives.
#include "gpu/cuda/encode/device_coder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "format/packed/block_decode.h"
#include "format/packed/block_encode.h"
#include "format/packed/lattice_block.h"
#include "format/packed/rounded_block.h"
#include "gpu/cuda/encode/device_blocks.h"
#include "gpu/cuda/encode/record_steps.h"
#include "gpu/cuda/encode/resident_volume.h"
#include "gpu/cuda/encode/summary_steps.h"
#include "gpu/cuda/runtime/current_device.h"
#include "tests/cuda/support/device_reads.h"
#include "tests/support/block_volumes.h"

namespace weir::device_coder_test {
namespace {

using Values = std::array<float, 512>;

// The blocks of a volume. If the volume is larger than one block, the first block begins 5, 0 and 3 voxels before it.
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

BlockConstants constants_of(const test::BlockVolume& volume) {
  BlockConstants constants;
  constants.minimum = *std::min_element(volume.values.begin(), volume.values.end());
  constants.maximum = *std::max_element(volume.values.begin(), volume.values.end());
  constants.below_one = kBelowOne;
  constants.below_more = kBelowMore;
  constants.tables = built_in_tables();
  return constants;
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
    for (const RungAsk& ask : {RungAsk{}, RungAsk{false, 6}, RungAsk{false, 6, {}, {1e-3, 2e-3, true}}}) {
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

TEST(DeviceCoder, NearRungsAndFloatsInOrderAreThoseOfTheHost) {
  WEIR_NEEDS_DEVICE();
  const auto coder = make_device_coder(0, expect_no_failure);
  RoundedBlock rounded;
  const ValueEncoder ordered(built_in_tables(), ValueEncoder::Kind::lattice);
  BlockConstants constants;
  constants.tables = built_in_tables();
  std::size_t rungs = 0;
  std::size_t exact = 0;
  std::vector<test::BlockVolume> volumes = test::block_volumes();
  for (test::BlockVolume& volume : test::mixed_volumes()) volumes.push_back(std::move(volume));
  for (const test::BlockVolume& volume : volumes) {
    SCOPED_TRACE(volume.name);
    const Blocks blocks(volume);
    for (const RungAsk& ask : {RungAsk{true, 18, {NearBlocks::all}}, RungAsk{false, 18, {NearBlocks::all, false, -9}},
                               RungAsk{false, 18, {NearBlocks::sparse, false, -9}},
                               RungAsk{false, 18, {NearBlocks::all, false, -9}, {1e-6, 2e-6, true}},
                               RungAsk{false, 18, {NearBlocks::all, false, -9}, {1e-6, 2e-6, false}}}) {
      const NearAsk& near = ask.near;
      const auto loaded = coder->load(volume.values, blocks.voxels, blocks.blocks);
      ASSERT_NE(loaded, nullptr);
      loaded->begin_survey(ask);
      const auto surveyed = loaded->end_survey();
      ASSERT_TRUE(surveyed);
      for (std::int64_t b = 0; b < weir::volume(blocks.count()); ++b) {
        const SurveyedBlock found = surveyed->block(static_cast<std::size_t>(b));
        const Values values = blocks.of(b);
        const bool sparse = 2 * std::count(values.begin(), values.end(), 0.0F) > 512;
        const bool has_some = all_finite(values) && found.figures.transformed != 0 && found.figures.lattice == 0 &&
                              found.figures.energy > 0 && (near.blocks == NearBlocks::all || sparse);
        ASSERT_EQ(found.figures.near, has_some ? near.most() : 0U) << b;
        if (!has_some) continue;
        rounded.set(values);
        const std::int32_t coarsest = coarsest_near_exponent(rounded.exponent());
        const auto start = static_cast<std::uint32_t>(near_rung_about(coarsest, near.wanted));
        for (std::uint32_t k = 0; k < found.figures.near; ++k) {
          const bool needed = !ask.searches() || found.figures.first_near + k == start;
          if (found.near[k].bytes == 0 && !needed) continue;
          const auto expected = rounded.cost(coarsest - static_cast<std::int32_t>(found.figures.first_near + k));
          ASSERT_EQ(found.near[k].bytes, expected ? expected->bytes : kNoNearBytes) << b << ", " << k;
          ASSERT_EQ(found.near[k].squared_error, expected ? expected->squared_error : 0) << b << ", " << k;
          ++rungs;
        }
        std::array<std::byte, 4096> out;
        const std::uint32_t bytes = encode_exact(ordered, constants, std::nullopt, values, out);
        ASSERT_EQ(found.figures.ordered_bytes, near.all || sparse ? bytes : 0U) << b;
        exact += found.figures.ordered_bytes != 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(rungs, 4000U);
  EXPECT_GT(exact, 300U);
}

TEST(DeviceCoder, StreamsAndDecodedValuesAreThoseOfTheHost) {
  WEIR_NEEDS_DEVICE();
  const auto coder = make_device_coder(0, expect_no_failure);
  TransformBlock transform;
  std::size_t compared = 0;
  for (const test::BlockVolume& volume : test::block_volumes()) {
    SCOPED_TRACE(volume.name);
    const Blocks blocks(volume);
    BlockConstants constants = constants_of(volume);
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

TEST(DeviceCoder, StreamsOfRoundedValuesAndOfFloatsInOrderAreThoseOfTheHost) {
  WEIR_NEEDS_DEVICE();
  const auto coder = make_device_coder(0, expect_no_failure);
  RoundedBlock rounded;
  const ValueEncoder ordered(built_in_tables(), ValueEncoder::Kind::lattice);
  std::size_t compared = 0;
  for (const test::BlockVolume& volume : test::mixed_volumes()) {
    SCOPED_TRACE(volume.name);
    const Blocks blocks(volume);
    const BlockConstants constants = constants_of(volume);
    const auto loaded = coder->load(volume.values, blocks.voxels, blocks.blocks);
    ASSERT_NE(loaded, nullptr);
    for (std::int32_t rung = 0; rung < kNearRungs; rung += 3) {
      std::vector<StreamAsk> asks;
      std::vector<std::vector<std::byte>> expected;
      const auto ask = [&](std::uint32_t b, std::vector<std::byte> stream, std::int32_t step, StreamAskKind kind) {
        const std::uint32_t offset = asks.empty() ? 0 : asks.back().offset + asks.back().bytes;
        asks.push_back(
            {{}, b, offset, static_cast<std::uint16_t>(stream.size()), static_cast<std::int16_t>(step), kind});
        expected.push_back(std::move(stream));
      };
      for (std::uint32_t b = 0; b < weir::volume(blocks.count()); ++b) {
        const Values values = blocks.of(b);
        rounded.set(values);
        const std::int32_t exponent = coarsest_near_exponent(rounded.exponent()) - rung;
        if (const auto cost = rounded.cost(exponent)) {
          std::vector<std::byte> stream(cost->bytes);
          if (rounded.encode(exponent, stream) && !rounded.coarser()) {
            ask(b, std::move(stream), exponent, StreamAskKind::rounded);
          }
        }
        std::vector<std::byte> stream(4096);
        stream.resize(encode_exact(ordered, constants, std::nullopt, values, stream));
        if (is_ordered(stream)) ask(b, std::move(stream), 0, StreamAskKind::exact);
      }
      ASSERT_FALSE(asks.empty());
      const auto pending = loaded->encode(asks, constants);
      ASSERT_NE(pending, nullptr);
      const auto found = pending->wait();
      ASSERT_TRUE(found);
      for (std::size_t i = 0; i < asks.size(); ++i) {
        if (found->made[i] == 0) continue;
        ASSERT_EQ(std::memcmp(expected[i].data(), found->bytes.data() + asks[i].offset, asks[i].bytes), 0) << i;
        Values decoded;
        ASSERT_TRUE(decode_block(constants, {}, expected[i].data(), asks[i].bytes, decoded.data()));
        ASSERT_EQ(std::memcmp(decoded.data(), found->decoded.data() + 512 * i, sizeof decoded), 0) << i;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 1000U);
}

// Compares with the steps' results on the host, which tests/fake_coder/ compares with the CPU's own code.
TEST(ResidentVolume, SummariesRecordsValuesAndCountsAreThoseOfTheStepsOnTheHost) {
  WEIR_NEEDS_DEVICE();
  const KeptDevice kept(0);  // an earlier test may have left another device current
  using namespace encode_detail;
  const DigestTables tables;
  std::size_t summarized = 0;
  std::size_t recorded = 0;
  for (const test::BlockVolume& volume : test::block_volumes()) {
    SCOPED_TRACE(volume.name);
    const Blocks blocks(volume);
    const DeviceArray<float> on_device(volume.values);
    const auto resident = make_resident_volume(0, on_device.data(), blocks.voxels, expect_no_failure);
    const auto opened = resident->open(blocks.blocks);
    ASSERT_NE(opened, nullptr);
    const std::int64_t count = weir::volume(blocks.count());

    std::vector<std::uint32_t> wanted;
    for (std::int64_t b = count - 1; b >= 0; b -= 3) wanted.push_back(static_cast<std::uint32_t>(b));
    const auto values = opened->values(wanted);
    ASSERT_TRUE(values);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const Values expected = blocks.of(wanted[i]);
      ASSERT_EQ(std::memcmp(expected.data(), values->data() + 512 * i, sizeof expected), 0) << wanted[i];
    }

    const std::optional<BlockBox> placed = block_box(blocks.voxels, blocks.blocks);
    ASSERT_TRUE(placed);
    BlockBox box = *placed;
    box.values = volume.values.data();
    const Index3 first = {floor_div(blocks.blocks.lo.x, 8), floor_div(blocks.blocks.lo.y, 8),
                          floor_div(blocks.blocks.lo.z, 8)};
    const NodeLattice lattice = make_lattice(blocks.voxels, 8);
    const BlockPlace place{{first.x - lattice.first.x, first.y - lattice.first.y, first.z - lattice.first.z},
                           {lattice.count.x, lattice.count.y},
                           {static_cast<std::uint32_t>(first.x % 2), static_cast<std::uint32_t>(first.y % 2),
                            static_cast<std::uint32_t>(first.z % 2)}};
    opened->begin_survey({});
    const auto surveyed = opened->end_survey();
    ASSERT_TRUE(surveyed);
    std::vector<BlockSummary> expected(static_cast<std::size_t>(count));
    SummaryStage stage;
    for (std::uint32_t b = 0; b < count; ++b) {
      summarize_block(HostWarp{}, {box, place, &tables, expected.data()}, tables, b, stage);
      const BlockSummary& found = surveyed->summaries[b];
      ASSERT_EQ(found.finite, expected[b].finite) << b;
      if (found.finite < 512) continue;
      ASSERT_EQ(std::memcmp(&found, &expected[b], sizeof found), 0) << b;
      ++summarized;
    }

    TransformBlock transform;
    std::vector<StreamAsk> asks;
    std::uint32_t offset = 0;
    BlockConstants constants = constants_of(volume);
    constants.coarsest = kMostStep;
    for (std::int64_t b = 0; b < count; ++b) {
      const Values own = blocks.of(b);
      if (!all_finite(own) || !transform.set(own) || !(transform.largest() > 0)) continue;
      const std::int32_t step = rung_step(first_rung_step(transform.largest()), 9);
      const MeanRange means{transform.mean(), transform.mean()};
      if (step < kLeastStep || step > kMostStep || mean_bits(means, step) == kNoMeanBits) continue;
      const TransformBlock::Cost cost = transform.cost(step);
      if (cost.bits > 8 * 2040) continue;
      const auto bytes = static_cast<std::uint16_t>(stream_bytes(cost.bits, mean_bits(means, step)));
      asks.push_back({means, static_cast<std::uint32_t>(b), offset, bytes, static_cast<std::int16_t>(step)});
      offset += bytes;
      constants.coarsest = std::min<std::int32_t>(constants.coarsest, step);
    }
    std::erase_if(asks, [&](const StreamAsk& ask) { return ask.step > constants.coarsest + 63; });
    if (asks.empty()) continue;
    const auto pending = opened->encode(asks, constants);
    ASSERT_NE(pending, nullptr);
    const auto made = pending->wait();
    ASSERT_TRUE(made);
    for (std::size_t i = 0; i < asks.size(); ++i) {
      if (made->made[i] == 0) continue;
      Values decoded;
      ASSERT_TRUE(
          decode_block(constants, asks[i].means, made->bytes.data() + asks[i].offset, asks[i].bytes, decoded.data()));
      LeafRecord record;
      Digest source;
      const RecordCall call{box, place, &tables, &asks[i], 1, decoded.data(), &record, &source};
      StatisticsTile tile;
      RecordStage record_stage;
      add_statistics(HostWarp{}, call, 0, tile);
      make_record(HostWarp{}, call, tables, 0, record_stage);
      ASSERT_EQ(std::memcmp(&record, &made->records[i], sizeof record), 0) << asks[i].block;
      ASSERT_EQ(source, made->sources[i]) << asks[i].block;
      ++recorded;
    }
  }
  EXPECT_GT(summarized, 300U);
  EXPECT_GT(recorded, 200U);
}

TEST(ResidentVolume, CountsEveryFiniteValueAndReadsAnyBox) {
  WEIR_NEEDS_DEVICE();
  const KeptDevice kept(0);
  const Box voxels{{-3, 0, 9}, {60, 41, 40}};
  std::vector<float> values(static_cast<std::size_t>(voxels.voxels()));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = i % 7 < 5 ? 0.0F : static_cast<float>(i % 1000) / 8;
  values[5] = std::nanf("");
  const DeviceArray<float> on_device(values);
  const auto resident = make_resident_volume(0, on_device.data(), voxels, expect_no_failure);
  const auto counts = resident->count(-2, 0.0, 500);
  ASSERT_TRUE(counts);
  std::vector<std::uint64_t> expected(500);
  for (const float v : values) {
    if (std::isfinite(v)) ++expected[static_cast<std::size_t>(std::floor(v * 4))];
  }
  EXPECT_EQ(*counts, expected);
  const Box box{{2, 7, 11}, {33, 30, 29}};
  std::vector<float> read(static_cast<std::size_t>(box.voxels()));
  resident->read(box, read);
  for (std::int64_t i = 0; i < box.voxels(); ++i) {
    const Index3 voxel = box.lo + index_at(i, box.extent());
    ASSERT_EQ(read[static_cast<std::size_t>(i)],
              values[static_cast<std::size_t>(linear_index(voxel - voxels.lo, voxels.extent()))]);
  }
}

}  // namespace
}  // namespace weir::device_coder_test
