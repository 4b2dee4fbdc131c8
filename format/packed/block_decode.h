// Decodes the stream of a packed block into its 512 values (FORMAT.md, "Packed data"). This is the only definition of a
// decoded value; the device shares its parts.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_constants.h"
#include "format/packed/block_scan.h"
#include "format/packed/block_steps.h"
#include "format/packed/coefficient_decoder.h"
#include "format/packed/inverse_transform.h"
#include "format/packed/lattice_codes.h"
#include "format/packed/stream_length.h"

namespace weir {

namespace packed_detail {

template <typename T>
WEIR_HOST_DEVICE inline T load_bytes(const std::byte* at) {
  T value;
  __builtin_memcpy(&value, at, sizeof value);
  return value;
}

// NaN, which damaged constants can produce, becomes the minimum.
WEIR_HOST_DEVICE inline float clamp_to(const BlockConstants& constants, float v) {
  return v >= constants.minimum ? (v <= constants.maximum ? v : constants.maximum) : constants.minimum;
}

/// The values that are known once all magnitudes are decoded.
struct CodedNumber {
  std::uint32_t code = 0;     ///< the code of the mean, or the base
  std::uint32_t payload = 0;  ///< the payload in the coders' final states: signs, then low bits of the code
  std::uint32_t early = 0;    ///< number of signs in front; the others are in the payload
};

/// Reads the code except its low bits. `first` and `second` are the final states of the `states` coders; `nonzero`
/// magnitudes are not zero.
WEIR_HOST_DEVICE inline CodedNumber read_number(BitReader& bits, unsigned states, std::uint32_t first,
                                                std::uint32_t second, std::uint32_t nonzero, unsigned number_bits) {
  const unsigned capacity = 16 * states;
  const unsigned late = nonzero < capacity ? nonzero : capacity;
  const unsigned moved = capacity - late < number_bits ? capacity - late : number_bits;
  CodedNumber number;
  number.payload = (first & 0xFFFFU) | (states == 2 ? second << 16U : 0);
  number.early = nonzero - late;
  number.code = bits.read(number_bits - moved);
  if (moved > 0) {
    const std::uint32_t low = number.payload >> late & (moved == 32 ? ~0U : (1U << moved) - 1U);
    number.code = (moved == 32 ? 0 : number.code << moved) | low;
  }
  return number;
}

WEIR_HOST_DEVICE inline float coefficient(std::uint32_t signed_magnitude, const BlockConstants& constants, float step) {
  if (signed_magnitude == 0) return 0.0F;
  const bool negative = signed_magnitude >> 31U != 0;
  const std::uint32_t magnitude = negative ? 0U - signed_magnitude : signed_magnitude;
  const float whole = static_cast<float>(magnitude) - (magnitude == 1 ? constants.below_one : constants.below_more);
  const float size = whole * step;
  return negative ? -size : size;
}

/// Reads the fixed part of a transformed block's stream: its step, and the bits of its mean's code. False if invalid.
WEIR_HOST_DEVICE inline bool read_step(const BlockConstants& constants, const MeanRange& range, const std::byte* stream,
                                       std::int32_t& step, unsigned& number_bits) {
  step = constants.coarsest + static_cast<std::int32_t>(static_cast<unsigned>(stream[0]) >> 2U);
  if (step < kLeastStep || step > kMostStep) return false;
  number_bits = mean_bits(range, step);
  return number_bits != kNoMeanBits;
}

/// The fixed part of a lattice block's stream.
struct LatticeHead {
  unsigned predictor = 0;
  LatticeKind kind = LatticeKind::file;
  float minimum = 0;
  float quantum = 0;
  unsigned base_bits = 0;
  const std::byte* front = nullptr;  ///< the bytes that follow
};

/// Returns false if the stream is invalid.
WEIR_HOST_DEVICE inline bool read_lattice_head(const BlockConstants& constants, const std::byte* stream,
                                               std::uint32_t bytes, LatticeHead& read) {
  const auto head = static_cast<unsigned>(stream[0]);
  read.predictor = head >> 2U & 3U;
  read.kind = static_cast<LatticeKind>(head >> 4U & 3U);
  if (head >> 6U != 0 || read.kind > LatticeKind::ordered) return false;
  read.minimum = constants.lattice_minimum;
  read.quantum = constants.lattice_quantum;
  read.base_bits = constants.lattice_bits;
  read.front = stream + 1;
  if (read.kind == LatticeKind::own) {
    if (bytes < 9) return false;
    read.minimum = load_bytes<float>(read.front);
    read.quantum = load_bytes<float>(read.front + 4);
    if (!(read.minimum - read.minimum == 0 && read.quantum - read.quantum == 0)) return false;  // not finite
    read.front += 8;
    read.base_bits = 24;
  } else if (read.kind == LatticeKind::ordered) {
    read.base_bits = 32;
  }
  return true;
}

/// Returns the value of a code on a lattice.
WEIR_HOST_DEVICE inline float lattice_value(const BlockConstants& constants, float minimum, float quantum,
                                            std::uint32_t code) {
  const float product = static_cast<float>(code) * quantum;
  return clamp_to(constants, product + minimum);
}

/// Returns false if a code is too large.
WEIR_HOST_DEVICE inline bool values_of_codes(const BlockConstants& constants, const LatticeHead& head,
                                             const std::uint32_t* codes, float* values) {
  std::uint32_t all = 0;
  for (unsigned i = 0; i < 512; ++i) {
    if (head.kind == LatticeKind::ordered) {
      values[i] = float_of_ordered(codes[i]);
      continue;
    }
    all |= codes[i];
    values[i] = lattice_value(constants, head.minimum, head.quantum, codes[i]);
  }
  return all >> 24U == 0;
}

WEIR_HOST_DEVICE inline CoderContexts residual_contexts(const BlockConstants& constants) {
  return {constants.tables + std::size_t{kPackedSymbols} * kPackedLevels * kPackedBands, false};
}

/// Reads the one value of a block that is coded by its mean. Returns false if the stream is invalid.
WEIR_HOST_DEVICE inline bool read_mean(const BlockConstants& constants, const MeanRange& range, const std::byte* stream,
                                       std::uint32_t bytes, float& value) {
  std::int32_t step;
  unsigned number_bits;
  if (!read_step(constants, range, stream, step, number_bits) || (number_bits + 7) / 8 > bytes - 1) return false;
  BitReader bits(stream + 1, bytes - 1);
  value = clamp_to(constants, decode_mean(range, step, bits.read(number_bits)));
  return true;
}

WEIR_HOST_DEVICE inline bool decode_mean_alone(const BlockConstants& constants, const MeanRange& range,
                                               const std::byte* stream, std::uint32_t bytes, float* values) {
  float value;
  if (!read_mean(constants, range, stream, bytes, value)) return false;
  for (unsigned i = 0; i < 512; ++i) values[i] = value;
  return true;
}

/// Sets `uniform` to whether a raw block has one value. Returns false if the stream is invalid.
WEIR_HOST_DEVICE inline bool read_raw_head(const std::byte* stream, std::uint32_t bytes, bool& uniform) {
  const auto head = static_cast<unsigned>(stream[0]);
  uniform = (head >> 2U & 1U) != 0;
  return head >> 3U == 0 && bytes == (uniform ? kOneValueStreamBytes : kRawStreamBytes);
}

WEIR_HOST_DEVICE inline bool decode_raw(const std::byte* stream, std::uint32_t bytes, float* values) {
  bool uniform;
  if (!read_raw_head(stream, bytes, uniform)) return false;
  for (unsigned i = 0; i < 512; ++i) values[i] = load_bytes<float>(stream + 1 + (uniform ? 0 : 4 * i));
  return true;
}

}  // namespace packed_detail

/// Decodes a stream into 512 values (x << 6 | y << 3 | z). Returns false if the stream is invalid; `values` then hold
/// anything. Never reads outside the `bytes` bytes of the stream.
bool decode_block(const BlockConstants& constants, const MeanRange& range, const std::byte* stream, std::uint32_t bytes,
                  float* values);

}  // namespace weir
