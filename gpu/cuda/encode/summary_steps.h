// How a warp summarises a block of finite values, sum by sum as summarize_leaf() of compressor/leaf/leaf_summary.h
// does; how values are counted in bins, and copied block by block. For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "gpu/cuda/encode/digest_steps.h"
#include "gpu/cuda/encode/encode_call.h"
#include "gpu/cuda/encode/transform_steps.h"
#include "gpu/cuda/encode/warp_lanes.h"

namespace weir {
namespace encode_detail {

// The number of lanes that sum a block's values. Half as many find the extremes.
inline constexpr unsigned kSumLanes = 16;

// A warp's shared memory.
struct alignas(16) SummaryStage {
  float values[kStageWords];
  float low[kGroup];
  float high[kGroup];
  std::uint64_t lanes[kStripeWords];
};

// What the bits of a block's values tell.
struct ScannedBits {
  std::uint32_t differ = 0;  // bits that differ from the first value in any value
  std::uint32_t non_finite = 0;
  std::uint32_t zeros = 0;
};

template <class Warp>
WEIR_HOST_DEVICE ScannedBits scan_stage(const Warp& warp, const float* stage) {
  typename Warp::template Own<std::uint32_t> differ, non_finite, zeros;
  warp.each([&](unsigned lane) {
    const std::uint32_t first = bits_of(stage[0]);
    for (unsigned k = 0; k < 512 / kLanes; ++k) {
      const std::uint32_t bits = bits_of(stage[stage_of(lane + kLanes * k)]);
      differ(lane) |= bits ^ first;
      non_finite(lane) += (bits & 0x7F800000U) == 0x7F800000U ? 1U : 0U;
      zeros(lane) += (bits & 0x7FFFFFFFU) == 0 ? 1U : 0U;
    }
  });
  const auto sum = [](std::uint32_t a, std::uint32_t b) { return a + b; };
  ScannedBits scan;
  scan.differ = warp.of_all(differ, [](std::uint32_t a, std::uint32_t b) { return a | b; });
  scan.non_finite = warp.of_all(non_finite, sum);
  scan.zeros = warp.of_all(zeros, sum);
  return scan;
}

// Finds the first least and the first largest value of each of eight lanes, as the CPU has them in a vector.
template <class Warp>
WEIR_HOST_DEVICE void find_extremes(const Warp& warp, SummaryStage& stage) {
  warp.each([&](unsigned lane) {
    if (lane >= kGroup) return;
    float low = stage.values[0];
    float high = low;
    for (unsigned i = lane; i < 512; i += kGroup) {
      const float v = stage.values[stage_of_x_fastest(i)];
      low = v < low ? v : low;
      high = v > high ? v : high;
    }
    stage.low[lane] = low;
    stage.high[lane] = high;
  });
}

// Returns the sum of of(value) over all values.
template <class Warp, class Of>
WEIR_HOST_DEVICE double sum_stage(const Warp& warp, const float* stage, const Of& of) {
  typename Warp::template Own<double> own;
  warp.each([&](unsigned lane) {
    double sum = 0;
    if (lane < kSumLanes) {
      for (unsigned i = lane; i < 512; i += kSumLanes) sum += of(static_cast<double>(stage[stage_of_x_fastest(i)]));
    }
    own(lane) = sum;
  });
  return warp.add_pairwise(own);
}

}  // namespace encode_detail

/// Summarises a block of the call that lies wholly in its volume. If some values are not finite, writes only the number
/// of finite values.
template <class Warp>
WEIR_HOST_DEVICE void summarize_block(const Warp& warp, const SummaryCall& call, const DigestTables& tables,
                                      std::uint32_t block, encode_detail::SummaryStage& stage) {
  using namespace encode_detail;
  gather_block(warp, call.box, block, stage.values);
  BlockSummary& out = call.summaries[block];
  const ScannedBits scan = scan_stage(warp, stage.values);
  if (scan.non_finite > 0) {
    warp.each([&](unsigned lane) {
      if (lane != 0) return;
      out = {};
      out.finite = static_cast<std::uint16_t>(512 - scan.non_finite);
    });
    return;
  }
  float mean = stage.values[0];
  double residual = 0;
  double squares = 0;
  if (scan.differ != 0) {
    find_extremes(warp, stage);
    mean = static_cast<float>(sum_stage(warp, stage.values, [](double v) { return v; }) / 512.0);
    const auto centre = static_cast<double>(mean);
    residual = sum_stage(warp, stage.values, [&](double v) { return v - centre; });
    squares = sum_stage(warp, stage.values, [&](double v) { return (v - centre) * (v - centre); });
  }
  digest_stage(warp, tables, stage.values, stage.lanes, reinterpret_cast<std::uint8_t*>(&out.digest));
  warp.each([&](unsigned lane) {
    if (lane != 0) return;
    float low = mean;
    float high = mean;
    if (scan.differ != 0) {
      low = stage.low[0];
      high = stage.high[0];
      for (unsigned l = 1; l < kGroup; ++l) {
        low = stage.low[l] < low ? stage.low[l] : low;
        high = stage.high[l] > high ? stage.high[l] : high;
      }
    }
    out.min = low;
    out.max = high;
    out.mean = mean;
    const auto sampled = static_cast<unsigned>(sample_position(call.place.linear(call.box, block), 512));
    out.sample = stage.values[stage_of_x_fastest(sampled)];
    out.residual = static_cast<float>(residual);
    out.finite = 512;
    out.same_bits = scan.differ == 0 ? 1 : 0;
    out.zeros = static_cast<std::uint16_t>(scan.zeros & 0x7FFFU);
    out.sse = squares;
  });
}

/// Copies the values of the call's block number `i`.
template <class Warp>
WEIR_HOST_DEVICE void copy_block(const Warp& warp, const ValuesCall& call, std::uint32_t i, float* stage) {
  using namespace encode_detail;
  gather_block(warp, call.box, call.blocks[i], stage);
  warp.each([&](unsigned lane) {
    for (unsigned k = lane; k < 512; k += kLanes) call.values[std::size_t{512} * i + k] = stage[stage_of(k)];
  });
}

/// Returns the bin of a value, or kMostCountedBins if the value is not finite or lies in no bin.
WEIR_HOST_DEVICE inline std::uint32_t bin_of_value(const CountCall& call, float v) {
  if (!(v - v == 0)) return kMostCountedBins;
  const double bin = ::floor(static_cast<double>(v) * call.scale) - call.base;
  return bin >= 0 && bin < call.bins ? static_cast<std::uint32_t>(bin) : kMostCountedBins;
}

}  // namespace weir
