// How records of written streams are made from the values that the streams decode to, sum by sum as in
// compressor/encode/record_batch.h. One thread per block makes the statistics, one warp per block the rest. For host
// and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "gpu/cuda/encode/digest_steps.h"
#include "gpu/cuda/encode/encode_call.h"
#include "gpu/cuda/encode/summary_steps.h"
#include "gpu/cuda/encode/warp_lanes.h"

namespace weir {
namespace encode_detail {

// Values of 32 blocks, 32 per block at a time, arranged so that no two lanes use the same bank.
struct StatisticsTile {
  float values[kLanes][kLanes + 1];
};

// Layers of a block that the neighbours of its macrocell read: across x, across y, the edge of both, and the whole
// block.
inline constexpr unsigned kLayers = 4;
inline constexpr float kNoLow = 3.402823466e+38F;

// A warp's shared memory.
struct alignas(16) RecordStage {
  float values[kStageWords];  // of the source
  float low[kLayers][kGroup];
  float high[kLayers][kGroup];
  std::uint64_t lanes[kStripeWords];
};

// Returns the bounds of a layer at all places along z.
WEIR_HOST_DEVICE inline MinMax layer_bounds(const RecordStage& stage, unsigned layer) {
  MinMax bounds{stage.low[layer][0], stage.high[layer][0]};
  for (unsigned z = 1; z < kGroup; ++z) {
    if (stage.low[layer][z] < bounds.min) bounds.min = stage.low[layer][z];
    if (stage.high[layer][z] > bounds.max) bounds.max = stage.high[layer][z];
  }
  return bounds;
}

// For a block that lies at its macrocell's surface, on side 0 or 7 of each axis.
template <class Warp>
WEIR_HOST_DEVICE void bound_stage_layers(const Warp& warp, const float* decoded, const unsigned (&side)[3],
                                         RecordStage& stage) {
  warp.each([&](unsigned lane) {
    const unsigned layer = lane / kGroup;
    const unsigned z = lane % kGroup;
    bool any = false;
    float low = 0;
    float high = 0;
    for (unsigned row = 0; row < 64; ++row) {
      const unsigned x = row / 8, y = row % 8;
      const bool across_x = x == side[0], across_y = y == side[1];
      const bool in = layer == 0 ? across_x : layer == 1 ? across_y : layer == 2 ? across_x && across_y : true;
      if (!in) continue;
      const float v = decoded[8 * row + z];
      low = !any || v < low ? v : low;
      high = !any || v > high ? v : high;
      any = true;
    }
    stage.low[layer][z] = low;
    stage.high[layer][z] = high;
  });
}

}  // namespace encode_detail

/// Calculates mean, squared deviations and bounds of the values of asks [first, first + 32), as far as they exist.
/// Adds one value after the other, as NodeStatistics does.
template <class Warp>
WEIR_HOST_DEVICE void add_statistics(const Warp& warp, const RecordCall& call, std::uint32_t first,
                                     encode_detail::StatisticsTile& tile) {
  using namespace encode_detail;
  typename Warp::template Own<float> low, high;
  typename Warp::template Own<double> mean, squares;
  warp.each([&](unsigned lane) {
    low(lane) = kNoLow;
    high(lane) = -kNoLow;
  });
  for (unsigned piece = 0; piece < 512; piece += kLanes) {
    warp.each([&](unsigned lane) {
      for (unsigned b = 0; b < kLanes && first + b < call.count; ++b) {
        tile.values[b][lane] = call.decoded[std::size_t{512} * (first + b) + piece + lane];
      }
    });
    warp.each([&](unsigned lane) {
      if (first + lane >= call.count) return;
      for (unsigned k = 0; k < kLanes; ++k) {
        const float v = tile.values[lane][k];
        if (v < low(lane)) low(lane) = v;
        if (v > high(lane)) high(lane) = v;
        const double delta = static_cast<double>(v) - mean(lane);
        mean(lane) += delta / static_cast<double>(piece + k + 1);
        squares(lane) += delta * (static_cast<double>(v) - mean(lane));
      }
    });
  }
  warp.each([&](unsigned lane) {
    if (first + lane >= call.count) return;
    LeafRecord& record = call.records[first + lane];
    record.mean = mean(lane);
    record.m2 = squares(lane);
    record.bounds = MinMax{low(lane), high(lane)};
    record.active = MinMax{kNoBounds.min, kNoBounds.max};  // all voxels are active
    record.inactive = 0;
    record.active_lo = {};
    record.active_end = {};
  });
}

/// Makes the bounds of the outer layers of ask `i`, its errors, and the digest of its source.
template <class Warp>
WEIR_HOST_DEVICE void make_record(const Warp& warp, const RecordCall& call, const DigestTables& tables, std::uint32_t i,
                                  encode_detail::RecordStage& stage) {
  using namespace encode_detail;
  const std::uint32_t block = call.asks[i].block;
  const float* decoded = call.decoded + std::size_t{512} * i;
  LeafRecord& record = call.records[i];
  gather_block(warp, call.box, block, stage.values);
  const std::uint32_t column = block % (call.box.blocks[0] * call.box.blocks[1]);
  const std::uint32_t at[3] = {column % call.box.blocks[0], column / call.box.blocks[0],
                               block / (call.box.blocks[0] * call.box.blocks[1])};
  unsigned side[3];
  for (unsigned axis = 0; axis < 3; ++axis) side[axis] = (call.place.odd[axis] + at[axis]) % 2 != 0 ? 7 : 0;
  bound_stage_layers(warp, decoded, side, stage);

  typename Warp::template Own<double> squared, largest;
  typename Warp::template Own<std::uint32_t> different, zeros_lost;
  warp.each([&](unsigned lane) {
    if (lane >= kSumLanes) return;
    for (unsigned k = lane; k < 512; k += kSumLanes) {
      const float s = stage.values[stage_of(k)];
      const float d = decoded[k];
      const double difference = static_cast<double>(s) - static_cast<double>(d);
      const double magnitude = difference < 0 ? -difference : difference;
      squared(lane) += difference * difference;
      largest(lane) = magnitude > largest(lane) ? magnitude : largest(lane);
      different(lane) += bits_of(s) != bits_of(d) ? 1U : 0U;
      zeros_lost(lane) += s == 0 && d != 0 ? 1U : 0U;
    }
  });
  const auto sum = [](std::uint32_t a, std::uint32_t b) { return a + b; };
  const double error = warp.add_pairwise(squared);
  const double most = warp.of_all(largest, [](double a, double b) { return b > a ? b : a; });
  const std::uint32_t others = warp.of_all(different, sum);
  const std::uint32_t lost = warp.of_all(zeros_lost, sum);
  digest_stage(warp, tables, stage.values, stage.lanes, reinterpret_cast<std::uint8_t*>(&call.sources[i]));
  warp.each([&](unsigned lane) {
    auto* const outward = reinterpret_cast<MinMax*>(&record.outward);
    const unsigned z = side[2];
    if (lane < 3) outward[lane] = layer_bounds(stage, lane);
    if (lane == 3) outward[3] = MinMax{stage.low[3][z], stage.high[3][z]};
    if (lane > 3 && lane < 7) outward[lane] = MinMax{stage.low[lane - 4][z], stage.high[lane - 4][z]};
    if (lane == 7) {
      record.squared_error = error;
      record.max_abs = most;
      record.kept = others == 0 ? Kept::all : Kept::lossy;
      record.zeros_lost = lost;
    }
  });
}

}  // namespace weir
