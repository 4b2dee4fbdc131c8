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

// NaN, which damaged constants can lead to, becomes the minimum.
WEIR_HOST_DEVICE inline float clamp_to(const BlockConstants& constants, float v) {
  return v >= constants.minimum ? (v <= constants.maximum ? v : constants.maximum) : constants.minimum;
}

WEIR_HOST_DEVICE inline float decode_mean(const MeanRange& range, std::int32_t step, std::uint32_t code) {
  const float offset = static_cast<float>(code) * mean_quantum(step);
  return range.low + offset;
}

/// What is known once all magnitudes are decoded.
struct CodedNumber {
  std::uint32_t code = 0;     ///< of the mean, or the base
  std::uint32_t payload = 0;  ///< what the coders' states end with: signs, then low bits of the code
  std::uint32_t early = 0;    ///< signs that lie in front; the others are the payload's
};

/// Reads the code but for its low bits; `first` and `second` are the states that `states` coders end with, `nonzero` of
/// the magnitudes are not zero.
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
  const CodedNumber number = read_number(bits, states, coder.state(0), coder.state(1), nonzero, number_bits);
  const std::uint32_t early = number.early;
  code = number.code;
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
      negative = (number.payload >> (seen - early) & 1U) != 0;
    }
    ++seen;
    if (negative) magnitudes[index] = 0U - magnitudes[index];
  }
  return front + bits.bytes_used() <= coder.words().at();
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

/// The fixed part of a transformed block's stream: its step, and bits of its mean's code. False where it is invalid.
WEIR_HOST_DEVICE inline bool read_step(const BlockConstants& constants, const MeanRange& range, const std::byte* stream,
                                       std::int32_t& step, unsigned& number_bits) {
  step = constants.coarsest + static_cast<std::int32_t>(static_cast<unsigned>(stream[0]) >> 2U);
  if (step < kLeastStep || step > kMostStep) return false;
  number_bits = mean_bits(range, step);
  return number_bits != kNoMeanBits;
}

WEIR_HOST_DEVICE inline bool decode_transform(const BlockConstants& constants, const BlockScan& scan,
                                              const MeanRange& range, const std::byte* stream, std::uint32_t bytes,
                                              float* values) {
  std::int32_t step;
  unsigned number_bits;
  if (!read_step(constants, range, stream, step, number_bits)) return false;
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
  inverse_transform_lines(values);
  const float mean = decode_mean(range, step, code);
  for (unsigned i = 0; i < 512; ++i) values[i] = clamp_to(constants, mean + values[i]);
  return true;
}

/// The fixed part of a lattice block's stream.
struct LatticeHead {
  unsigned predictor = 0;
  LatticeKind kind = LatticeKind::file;
  float minimum = 0;
  float quantum = 0;
  unsigned base_bits = 0;
  const std::byte* front = nullptr;  ///< what follows
};

/// False where the stream is invalid.
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

/// Of a lattice's code.
WEIR_HOST_DEVICE inline float lattice_value(const BlockConstants& constants, float minimum, float quantum,
                                            std::uint32_t code) {
  const float product = static_cast<float>(code) * quantum;
  return clamp_to(constants, product + minimum);
}

/// False where a code is too large.
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

WEIR_HOST_DEVICE inline bool decode_lattice(const BlockConstants& constants, const BlockScan& scan,
                                            const std::byte* stream, std::uint32_t bytes, float* values) {
  LatticeHead head;
  if (!read_lattice_head(constants, stream, bytes, head)) return false;
  BitReader bits(head.front, static_cast<std::uint32_t>(stream + bytes - head.front));
  const unsigned end = bits.read(6);
  if (end > 512 / kEndUnit) return false;
  std::uint32_t codes[513] = {};
  std::uint32_t base = 0;
  if (!decode_values(scan, residual_contexts(constants), head.front, stream + bytes, end, bits, head.base_bits, codes,
                     base)) {
    return false;
  }
  codes[0] = base;
  undo_prediction(head.predictor, head.kind == LatticeKind::ordered, codes);
  return values_of_codes(constants, head, codes, values);
}

/// The one value of a block that is coded by its mean. False where the stream is invalid.
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

/// Whether a raw block has one value. False where the stream is invalid.
WEIR_HOST_DEVICE inline bool read_raw_head(const std::byte* stream, std::uint32_t bytes, bool& uniform) {
  const auto head = static_cast<unsigned>(stream[0]);
  uniform = (head >> 2U & 1U) != 0;
  return head >> 3U == 0 && bytes == (uniform ? 5 : 2049);
}

WEIR_HOST_DEVICE inline bool decode_raw(const std::byte* stream, std::uint32_t bytes, float* values) {
  bool uniform;
  if (!read_raw_head(stream, bytes, uniform)) return false;
  for (unsigned i = 0; i < 512; ++i) values[i] = load_bytes<float>(stream + 1 + (uniform ? 0 : 4 * i));
  return true;
}

}  // namespace packed_detail

/// On the device, and to check the host's: everything one value after the other.
WEIR_HOST_DEVICE inline bool decode_block_plain(const BlockConstants& constants, const BlockScan& scan,
                                                const MeanRange& range, const std::byte* stream, std::uint32_t bytes,
                                                float* values) {
  using namespace packed_detail;
  if (bytes < 2) return false;
  switch (static_cast<StreamKind>(static_cast<unsigned>(stream[0]) & 3U)) {
    case StreamKind::mean:
      return decode_mean_alone(constants, range, stream, bytes, values);
    case StreamKind::transform:
      return decode_transform(constants, scan, range, stream, bytes, values);
    case StreamKind::lattice:
      return decode_lattice(constants, scan, stream, bytes, values);
    case StreamKind::raw:
      break;
  }
  return decode_raw(stream, bytes, values);
}

/// Decodes a stream into 512 values (x << 6 | y << 3 | z). False where the stream is invalid; `values` are then
/// anything. Never reads outside the `bytes` bytes of the stream.
bool decode_block(const BlockConstants& constants, const MeanRange& range, const std::byte* stream, std::uint32_t bytes,
                  float* values);

}  // namespace weir
