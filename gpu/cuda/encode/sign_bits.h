// How a warp joins the sign bits that its lanes hold. For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "gpu/cuda/encode/warp_lanes.h"

namespace weir::encode_detail {

/// Writes the lowest `count` bits (at most 32) of each lane's `signs` to `words`, lane after lane. `words` are zero,
/// and there is one more than the bits can fill. Returns the number of bits.
template <class Warp>
WEIR_HOST_DEVICE std::uint32_t join_signs(const Warp& warp, typename Warp::template Own<std::uint32_t>& signs,
                                          typename Warp::template Own<std::uint32_t>& count, std::uint32_t* words) {
  typename Warp::template Own<std::uint32_t> before;
  warp.each([&](unsigned lane) { before(lane) = count(lane); });
  const std::uint32_t all = warp.add_before(before);
  warp.each([&](unsigned lane) {
    if (count(lane) == 0) return;
    const std::uint32_t first = before(lane);
    warp.set_bits(&words[first / 32], signs(lane) << (first % 32));
    if (first % 32 + count(lane) > 32) warp.set_bits(&words[first / 32 + 1], signs(lane) >> (32 - first % 32));
  });
  return all;
}

}  // namespace weir::encode_detail
