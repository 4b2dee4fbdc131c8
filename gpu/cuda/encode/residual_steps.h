// How a warp predicts the codes of a block on a lattice, or of ordered floats. Operation by operation as residuals.h.
// For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/lattice_codes.h"
#include "gpu/cuda/encode/encoder_tables.h"
#include "gpu/cuda/encode/warp_lanes.h"
#include "gpu/cuda/packed/value_steps.h"

namespace weir::encode_detail {

using decode_detail::kStageX;
using decode_detail::kStageY;
using decode_detail::stage_of;

// A warp's shared memory. Arrays that are by index are laid out as stage_of() says.
struct alignas(16) LatticeStage {
  float values[kStageWords];         // by index
  std::uint32_t codes[kStageWords];  // by index; then residuals
  std::uint16_t symbols[512];        // by place: see residual_stream.h
  std::uint32_t signs[17];
};

// Returns a voxel's residual: its code minus the prediction from voxels before it; 0 for the first voxel.
template <class Sum>
WEIR_HOST_DEVICE inline std::uint32_t residual_at(const std::uint32_t* codes, unsigned predictor, bool ordered,
                                                  unsigned index) {
  if (index == 0) return 0;
  const std::uint32_t* at = codes + stage_of(index);
  return *at - static_cast<std::uint32_t>(predict_at<Sum, kStageX, kStageY>(predictor, ordered, at, index >= 64,
                                                                            (index & 56U) != 0, (index & 7U) != 0));
}

WEIR_HOST_DEVICE inline std::uint32_t size_of_residual(std::uint32_t residual) {
  return residual >> 31U != 0 ? 0U - residual : residual;
}

// Returns the sum of the three magnitudes just before an index along each axis, each limited to `most`.
WEIR_HOST_DEVICE inline std::uint32_t sizes_beside(const std::uint32_t* residuals, unsigned index, std::uint32_t most) {
  const std::uint32_t* at = residuals + stage_of(index);
  const auto size = [&](std::uint32_t residual) {
    const std::uint32_t m = size_of_residual(residual);
    return m < most ? m : most;
  };
  return (index >= 64 ? size(*(at - kStageX)) : 0U) + ((index & 56U) != 0 ? size(*(at - kStageY)) : 0U) +
         ((index & 7U) != 0 ? size(*(at - 1)) : 0U);
}

// Returns what best_predictor() returns. `Sum` has room for the sum of three codes.
template <class Sum, class Warp>
WEIR_HOST_DEVICE unsigned choose_predictor(const Warp& warp, const std::uint32_t* codes, bool ordered) {
  unsigned best = 0;
  std::uint32_t least = ~0U;
  typename Warp::template Own<std::uint32_t> bits;
  WEIR_NO_UNROLL
  for (unsigned predictor = 0; predictor < kPredictors; ++predictor) {
    warp.each([&](unsigned lane) {
      std::uint32_t sum = 0;
      WEIR_NO_UNROLL
      for (unsigned k = 0; k < 16; ++k) {
        const std::uint32_t m = 3U * size_of_residual(residual_at<Sum>(codes, predictor, ordered, lane + kLanes * k));
        sum += m == 0 ? 0U : 32U - static_cast<unsigned>(__builtin_clz(m));
      }
      bits(lane) = sum;
    });
    const std::uint32_t all = warp.of_all(bits, [](std::uint32_t a, std::uint32_t b) { return a + b; });
    if (all < least) {
      least = all;
      best = predictor;
    }
  }
  return best;
}

struct FoundResiduals {
  std::uint32_t last = 0;  // last place of the scan that is not zero; 0 if all are zero
  std::uint32_t bits = 0;  // all bits that are set in any magnitude
};
struct OwnResiduals {
  std::uint32_t of[16];
};

// Turns codes into residuals.
template <class Sum, class Warp>
WEIR_HOST_DEVICE FoundResiduals find_residuals(const Warp& warp, const CostTables& tables, unsigned predictor,
                                               bool ordered, std::uint32_t* codes) {
  typename Warp::template Own<OwnResiduals> own;
  typename Warp::template Own<std::uint32_t> last, bits;
  warp.each([&](unsigned lane) {
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      own(lane).of[k] = residual_at<Sum>(codes, predictor, ordered, lane + kLanes * k);
    }
  });
  warp.each([&](unsigned lane) {
    std::uint32_t most = 0;
    std::uint32_t all = 0;
    WEIR_UNROLL
    for (unsigned k = 0; k < 16; ++k) {
      const unsigned index = lane + kLanes * k;
      const std::uint32_t residual = own(lane).of[k];
      codes[stage_of(index)] = residual;
      const std::uint32_t place = residual == 0 ? 0U : tables.place[index] & 511U;
      most = place > most ? place : most;
      all |= size_of_residual(residual);
    }
    last(lane) = most;
    bits(lane) = all;
  });
  FoundResiduals found;
  found.last = warp.of_all(last, [](std::uint32_t a, std::uint32_t b) { return b > a ? b : a; });
  found.bits = warp.of_all(bits, [](std::uint32_t a, std::uint32_t b) { return a | b; });
  return found;
}

}  // namespace weir::encode_detail
