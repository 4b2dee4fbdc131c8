// How a warp gathers a block from a box of values and transforms it. Operation by operation as TransformBlock::set()
// of block_encode.h. For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_steps.h"
#include "format/packed/forward_transform.h"
#include "format/packed/quantiser.h"
#include "gpu/cuda/encode/encode_call.h"
#include "gpu/cuda/encode/warp_lanes.h"
#include "gpu/cuda/packed/value_steps.h"

namespace weir::encode_detail {

using decode_detail::for_lane_lines;
using decode_detail::stage_of;

// Returns where a row of eight coefficients along z begins on a stage.
WEIR_HOST_DEVICE constexpr unsigned stage_row(unsigned row) { return 9 * row; }

// A warp's shared memory.
struct alignas(16) BlockStage {
  float values[kStageWords];  // laid out as stage_of() says
  float row_largest[64];
  double row_energy[64];
};

// What is known of a block's values before the transform.
struct ValueRange8 {
  float low = 0;
  float high = 0;
  float mean = 0;
  bool transformed = false;  // the values can be transformed
};

template <class Warp>
WEIR_HOST_DEVICE void gather_block(const Warp& warp, const BlockBox& box, std::uint32_t block, float* stage) {
  const std::int32_t first[3] = {box.first(block, 0), box.first(block, 1), box.first(block, 2)};
  const auto inside = [&](unsigned axis, unsigned at) {
    const std::int32_t v = first[axis] + static_cast<std::int32_t>(at);
    return v < 0 ? 0 : v < box.extent[axis] ? v : box.extent[axis] - 1;
  };
  warp.each([&](unsigned lane) {
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      const unsigned i = lane + kLanes * k;  // x fastest
      const unsigned x = i & 7U, y = i >> 3U & 7U, z = i >> 6U;
      const std::int64_t row = inside(1, y) + std::int64_t{box.extent[1]} * inside(2, z);
      stage[stage_of(x << 6U | y << 3U | z)] = box.values[inside(0, x) + box.extent[0] * row];
    }
  });
}

// Calculates sums in eight lanes, each over the rows in order, as the CPU does.
template <class Warp>
WEIR_HOST_DEVICE ValueRange8 range_of_block(const Warp& warp, const float* stage) {
  typename Warp::template Own<float> low, high;
  typename Warp::template Own<double> own, sum;
  warp.each([&](unsigned lane) {
    const unsigned z = lane % kGroup;
    double total = 0;
    float least = stage[z];
    float most = least;
    for (unsigned row = 0; row < 64; ++row) {
      const float v = stage[stage_row(row) + z];
      least = v < least ? v : least;
      most = v > most ? v : most;
      total += static_cast<double>(v);
    }
    low(lane) = least;
    high(lane) = most;
    own(lane) = total;
  });
  ValueRange8 range;
  range.low = warp.of_all(low, [](float a, float b) { return b < a ? b : a; });
  range.high = warp.of_all(high, [](float a, float b) { return b > a ? b : a; });
  warp.add_in_order(own, sum);
  range.mean = static_cast<float>(sum(0) / 512);
  const float below = range.low < 0 ? -range.low : range.low;
  const float above = range.high < 0 ? -range.high : range.high;
  range.transformed = below < kLargestTransformed && above < kLargestTransformed &&
                      !(range.high - range.low < kLeastTransformed) && range.mean - range.mean == 0;
  return range;
}

// Largest size and total energy of the coefficients.
struct CoefficientSizes {
  float largest = 0;
  double energy = 0;
};

// Turns the values minus their mean into coefficients. The coefficient of the mean becomes 0.
template <class Warp>
WEIR_HOST_DEVICE void transform_stage(const Warp& warp, float mean, float* stage) {
  warp.each([&](unsigned lane) {
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      float& v = stage[stage_of(lane + kLanes * k)];
      v = v - mean;
    }
  });
  const auto line = [](float(&values)[8]) { forward_transform_8(values); };
  warp.each([&](unsigned lane) { for_lane_lines<1>(stage, lane, line); });
  warp.each([&](unsigned lane) { for_lane_lines<2>(stage, lane, line); });
  warp.each([&](unsigned lane) { for_lane_lines<0>(stage, lane, line); });
  warp.each([&](unsigned lane) {
    if (lane == 0) stage[0] = 0;
  });
}

template <class Warp>
WEIR_HOST_DEVICE CoefficientSizes measure_rows(const Warp& warp, BlockStage& stage) {
  typename Warp::template Own<float> largest;
  warp.each([&](unsigned lane) {
    float most_of_both = 0;
    WEIR_UNROLL
    for (unsigned half = 0; half < 2; ++half) {
      const unsigned row = lane + kLanes * half;
      float most = 0;
      double sum = 0;
      WEIR_UNROLL
      for (unsigned k = 0; k < 8; ++k) {
        const float c = stage.values[stage_row(row) + k];
        const float size = c < 0 ? -c : c;
        most = size > most ? size : most;
        const double wide = static_cast<double>(c);
        sum += wide * wide;
      }
      stage.row_largest[row] = most;
      stage.row_energy[row] = sum;
      most_of_both = most > most_of_both ? most : most_of_both;
    }
    largest(lane) = most_of_both;
  });
  CoefficientSizes sizes;
  sizes.largest = warp.of_all(largest, [](float a, float b) { return b > a ? b : a; });
  warp.each([&](unsigned) {
    double sum = 0;
    for (unsigned row = 0; row < 64; ++row) sum += stage.row_energy[row];
    sizes.energy = sum;
  });
  return sizes;
}

}  // namespace weir::encode_detail
