// Decodes the stream of a packed block into its 512 values (FORMAT.md, "Packed data"): the one definition of a decoded
// value. For host and device; on the device the caller passes a copy of kBlockScan in its own memory.
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

namespace weir {

/// The lowest bits of a stream's first byte.
enum class StreamKind : std::uint8_t { mean = 0, transform = 1, lattice = 2, raw = 3 };

namespace packed_detail {

template <typename T>
WEIR_HOST_DEVICE inline T load_bytes(const std::byte* at) {
  T value;
  __builtin_memcpy(&value, at, sizeof value);
  return value;
}

WEIR_HOST_DEVICE inline float clamp_to(const BlockConstants& constants, float v) {
  return v < constants.minimum ? constants.minimum : v > constants.maximum ? constants.maximum : v;
}

WEIR_HOST_DEVICE inline float decode_mean(const MeanRange& range, std::int32_t step, std::uint32_t code) {
  const float offset = static_cast<float>(code) * mean_quantum(step);
  return range.low + offset;
}

/// What a stream of coded values begins with, read in order; and what comes after them.
struct CodedValues {
  std::uint32_t code = 0;     ///< of the mean, or the base
  std::uint32_t nonzero = 0;  ///< magnitudes
  std::uint32_t payload = 0;
  unsigned capacity = 0;  ///< bits of the payload
};

/// Decodes magnitudes by index (513 entries, zero) and makes the signed values of them, modulo 2^32. `front` begins
/// after the kind; `number_bits` are those of the code. False where the stream is invalid.
WEIR_HOST_DEVICE inline bool decode_values(const BlockScan& scan, const CoderContexts& contexts, const std::byte* front,
                                           const std::byte* stream_end, unsigned end, BitReader& bits,
                                           unsigned number_bits, std::uint32_t* magnitudes, std::uint32_t& code) {
  const auto front_bytes = static_cast<std::uint32_t>(stream_end - front);
  if (end == 0) {
    code = bits.read(number_bits);
    return bits.bytes_used() <= front_bytes;
  }
  const unsigned states = states_of(end);
  const unsigned flags = bits.read(states);
  if (bits.bytes_used() > front_bytes) return false;
  RansDecoder coder;
  if (!coder.start(front + bits.bytes_used(), stream_end, states, flags)) return false;
  const std::uint32_t nonzero = decode_magnitudes(scan, coder, contexts, end, magnitudes);
  if (nonzero == ~0U) return false;
  const unsigned capacity = 16 * states;
  const std::uint32_t payload = (coder.state(0) & 0xFFFFU) | (states == 2 ? coder.state(1) << 16U : 0);
  const unsigned late = nonzero < capacity ? nonzero : capacity;
  const unsigned moved = capacity - late < number_bits ? capacity - late : number_bits;
  code = bits.read(number_bits - moved);
  if (moved > 0) {
    const std::uint32_t low = payload >> late & (moved == 32 ? ~0U : (1U << moved) - 1U);
    code = (moved == 32 ? 0 : code << moved) | low;
  }
  const std::uint32_t early = nonzero - late;
  std::uint32_t seen = 0;
  std::uint32_t signs = 0;
  for (unsigned place = 1; place < kEndUnit * end; ++place) {
    const std::uint16_t index = scan.index[place];
    if (magnitudes[index] == 0) continue;
    bool negative;
    if (seen < early) {
      if (seen % 16 == 0) signs = bits.read(early - seen < 16 ? early - seen : 16);
      negative = (signs & 1U) != 0;
      signs >>= 1U;
    } else {
      negative = (payload >> (seen - early) & 1U) != 0;
    }
    ++seen;
    if (negative) magnitudes[index] = 0U - magnitudes[index];
  }
  return front + bits.bytes_used() <= coder.at();
}

WEIR_HOST_DEVICE inline float coefficient(std::uint32_t signed_magnitude, const BlockConstants& constants, float step) {
  if (signed_magnitude == 0) return 0.0F;
  const bool negative = signed_magnitude >> 31U != 0;
  const std::uint32_t magnitude = negative ? 0U - signed_magnitude : signed_magnitude;
  const float whole = static_cast<float>(magnitude) - (magnitude == 1 ? constants.below_one : constants.below_more);
  const float size = whole * step;
  return negative ? -size : size;
}

/// The three passes of the inverse transform, one line of eight after the other.
WEIR_HOST_DEVICE inline void inverse_transform_lines(float* values) {
  float line[8];
  for (unsigned pass = 0; pass < 3; ++pass) {
    const unsigned stride = pass == 0 ? 1 : pass == 1 ? 8 : 64;
    for (unsigned n = 0; n < 64; ++n) {
      const unsigned first = pass == 0 ? 8 * n : pass == 1 ? (n >> 3U) * 64 + (n & 7U) : n;
      for (unsigned i = 0; i < 8; ++i) line[i] = values[first + i * stride];
      inverse_transform_8(line);
      for (unsigned i = 0; i < 8; ++i) values[first + i * stride] = line[i];
    }
  }
}

struct LineTransform {
  WEIR_HOST_DEVICE void operator()(float* values, float mean, const BlockConstants& constants) const {
    inverse_transform_lines(values);
    for (unsigned i = 0; i < 512; ++i) values[i] = clamp_to(constants, mean + values[i]);
  }
};

template <typename Transform>
WEIR_HOST_DEVICE inline bool decode_transform(const BlockConstants& constants, const BlockScan& scan,
                                              const MeanRange& range, const std::byte* stream, std::uint32_t bytes,
                                              float* values, const Transform& transform) {
  const std::int32_t step = constants.coarsest + static_cast<std::int32_t>(static_cast<unsigned>(stream[0]) >> 2U);
  if (step < kLeastStep || step > kMostStep) return false;
  const unsigned number_bits = mean_bits(range, step);
  if (number_bits == kNoMeanBits) return false;
  BitReader bits(stream + 1, bytes - 1);
  const unsigned end = bits.read(5) + 1;
  std::uint32_t magnitudes[513] = {};
  std::uint32_t code = 0;
  if (!decode_values(scan, {constants.tables, true}, stream + 1, stream + bytes, end, bits, number_bits, magnitudes,
                     code)) {
    return false;
  }
  const float size = step_size(step);
  for (unsigned i = 0; i < 512; ++i) values[i] = coefficient(magnitudes[i], constants, size);
  transform(values, decode_mean(range, step, code), constants);
  return true;
}

WEIR_HOST_DEVICE inline bool decode_lattice(const BlockConstants& constants, const BlockScan& scan,
                                            const std::byte* stream, std::uint32_t bytes, float* values) {
  const auto head = static_cast<unsigned>(stream[0]);
  const unsigned predictor = head >> 2U & 3U;
  const auto lattice = static_cast<LatticeKind>(head >> 4U & 3U);
  if (head >> 6U != 0 || lattice > LatticeKind::ordered) return false;
  float minimum = constants.lattice_minimum;
  float quantum = constants.lattice_quantum;
  unsigned number_bits = constants.lattice_bits;
  const std::byte* front = stream + 1;
  if (lattice == LatticeKind::own) {
    if (bytes < 9) return false;
    minimum = load_bytes<float>(front);
    quantum = load_bytes<float>(front + 4);
    front += 8;
    number_bits = 24;
  } else if (lattice == LatticeKind::ordered) {
    number_bits = 32;
  }
  BitReader bits(front, static_cast<std::uint32_t>(stream + bytes - front));
  const unsigned end = bits.read(6);
  if (end > 512 / kEndUnit) return false;
  std::uint32_t codes[513] = {};
  std::uint32_t base = 0;
  const CoderContexts contexts{constants.tables + std::size_t{kPackedSymbols} * kPackedLevels * kPackedBands, false};
  if (!decode_values(scan, contexts, front, stream + bytes, end, bits, number_bits, codes, base)) return false;
  codes[0] = base;
  undo_prediction(predictor, lattice == LatticeKind::ordered, codes);
  for (unsigned i = 0; i < 512; ++i) {
    if (lattice == LatticeKind::ordered) {
      values[i] = float_of_ordered(codes[i]);
      continue;
    }
    if (codes[i] >> 24U != 0) return false;
    const float product = static_cast<float>(codes[i]) * quantum;
    values[i] = product + minimum;
  }
  return true;
}

template <typename Transform>
WEIR_HOST_DEVICE inline bool decode_block(const BlockConstants& constants, const BlockScan& scan,
                                          const MeanRange& range, const std::byte* stream, std::uint32_t bytes,
                                          float* values, const Transform& transform) {
  if (bytes < 2) return false;
  const auto head = static_cast<unsigned>(stream[0]);
  switch (static_cast<StreamKind>(head & 3U)) {
    case StreamKind::mean: {
      const std::int32_t step = constants.coarsest + static_cast<std::int32_t>(head >> 2U);
      if (step < kLeastStep || step > kMostStep) return false;
      const unsigned number_bits = mean_bits(range, step);
      if (number_bits == kNoMeanBits || (number_bits + 7) / 8 > bytes - 1) return false;
      BitReader bits(stream + 1, bytes - 1);
      const float value = clamp_to(constants, decode_mean(range, step, bits.read(number_bits)));
      for (unsigned i = 0; i < 512; ++i) values[i] = value;
      return true;
    }
    case StreamKind::transform:
      return decode_transform(constants, scan, range, stream, bytes, values, transform);
    case StreamKind::lattice:
      return decode_lattice(constants, scan, stream, bytes, values);
    case StreamKind::raw:
      break;
  }
  const bool uniform = (head >> 2U & 1U) != 0;
  if (head >> 3U != 0 || bytes != (uniform ? 5 : 2049)) return false;
  for (unsigned i = 0; i < 512; ++i) values[i] = load_bytes<float>(stream + 1 + (uniform ? 0 : 4 * i));
  return true;
}

}  // namespace packed_detail

/// On the device, and to check the host's: everything one value after the other.
WEIR_HOST_DEVICE inline bool decode_block_plain(const BlockConstants& constants, const BlockScan& scan,
                                                const MeanRange& range, const std::byte* stream, std::uint32_t bytes,
                                                float* values) {
  return packed_detail::decode_block(constants, scan, range, stream, bytes, values, packed_detail::LineTransform());
}

/// Decodes a stream into 512 values (x << 6 | y << 3 | z). False where the stream is invalid; `values` are then
/// anything. Never reads outside the `bytes` bytes of the stream.
bool decode_block(const BlockConstants& constants, const MeanRange& range, const std::byte* stream, std::uint32_t bytes,
                  float* values);

}  // namespace weir
