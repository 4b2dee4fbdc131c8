// The decoded value of a leaf's voxel, for every leaf type and for host and device. This is the only definition of a
// decoded value in weir:
//   float32           the stored value
//   Fp4 Fp8 Fp16 FpN  fl(fl(code * quantum) + minimum): two roundings, never fused
// Layout of a leaf: format/layout/nanovdb_layout.h. This header includes no standard library.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/layout/nanovdb_layout.h"
#include "format/layout/nvdb_type.h"

namespace weir {

/// The largest log2(bits a voxel) of an FpN leaf; the field itself could hold 7.
inline constexpr unsigned kMaxLeafBitsLog2 = 4;

/// Returns the little-endian T at `at`. On the host `at` may have any alignment, because foreign files put the grid
/// anywhere; on the device the grid is in an aligned buffer.
template <typename T>
WEIR_HOST_DEVICE inline T load(const std::byte* at) {
#if defined(__CUDA_ARCH__)
  return *reinterpret_cast<const T*>(at);
#else
  T value;
  __builtin_memcpy(&value, at, sizeof value);
  return value;
#endif
}

/// Returns fl(fl(code * quantum) + minimum).
WEIR_HOST_DEVICE inline float dequantize(std::uint32_t code, float quantum, float minimum) {
#if defined(__CUDA_ARCH__)
  return __fadd_rn(__fmul_rn(static_cast<float>(code), quantum), minimum);
#else
  const float product = static_cast<float>(code) * quantum;  // -ffp-contract=off keeps the rounding
  return product + minimum;
#endif
}

/// Returns log2(bits a voxel) of an FpN leaf as stored in bits 5..7 of its flags; 5, 6 and 7 are invalid.
WEIR_HOST_DEVICE inline unsigned fpn_bits_log2(const std::byte* leaf) {
  return static_cast<unsigned>(leaf[nvdb::leaf::kFlags]) >> 5U;
}

/// Returns log2(bits a voxel) of a quantised leaf. The invalid widths of a damaged FpN leaf count as the largest valid
/// one, so that no code is read outside the leaf.
WEIR_HOST_DEVICE inline unsigned leaf_bits_log2(GridType type, const std::byte* leaf) {
  switch (type) {
    case GridType::fp4:
      return 2;
    case GridType::fp8:
      return 3;
    case GridType::fp16:
      return 4;
    default: {
      const unsigned log2 = fpn_bits_log2(leaf);
      return log2 < kMaxLeafBitsLog2 ? log2 : kMaxLeafBitsLog2;
    }
  }
}

/// Returns the code of voxel `i` (x<<6 | y<<3 | z) from codes of 1 << bits_log2 bits, packed from the lowest bit up.
WEIR_HOST_DEVICE inline std::uint32_t leaf_code(const std::byte* codes, unsigned bits_log2, unsigned i) {
  if (bits_log2 == 4) return load<std::uint16_t>(codes + 2 * static_cast<std::size_t>(i));
  const unsigned bit = i << bits_log2;
  const auto byte = static_cast<unsigned>(codes[bit >> 3U]);
  return (byte >> (bit & 7U)) & ((1U << (1U << bits_log2)) - 1U);
}

/// Returns the decoded value of voxel `i` (x<<6 | y<<3 | z, below 512) of a leaf.
WEIR_HOST_DEVICE inline float leaf_value(GridType type, const std::byte* leaf, unsigned i) {
  if (type == GridType::float32) {
    return load<float>(leaf + nvdb::leaf::kValues + sizeof(float) * static_cast<std::size_t>(i));
  }
  const std::uint32_t code = leaf_code(leaf + nvdb::leaf::kCodes, leaf_bits_log2(type, leaf), i);
  return dequantize(code, load<float>(leaf + nvdb::leaf::kQuantum), load<float>(leaf + nvdb::leaf::kQuantMinimum));
}

/// Returns whether voxel `i` of a leaf is active.
WEIR_HOST_DEVICE inline bool leaf_active(const std::byte* leaf, unsigned i) {
  return ((static_cast<unsigned>(leaf[nvdb::leaf::kValueMask + (i >> 3U)]) >> (i & 7U)) & 1U) != 0;
}

/// Returns the bytes of a quantised leaf of 1 << bits_log2 bits a voxel.
WEIR_HOST_DEVICE inline std::uint64_t quantised_leaf_bytes(unsigned bits_log2) {
  return nvdb::kLeafHeadBytes + (std::uint64_t{64} << bits_log2);
}

}  // namespace weir
