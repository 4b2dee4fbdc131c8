// FORMAT.md's "Packed data" read plainly, one value after the other: what decode_block() is compared with, and what
// comments of the fast decoders name.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/packed/block_constants.h"
#include "format/packed/block_decode.h"
#include "format/packed/block_scan.h"
#include "format/packed/coefficient_decoder.h"
#include "format/packed/inverse_transform.h"
#include "format/packed/lattice_codes.h"

namespace weir::packed_test::plain {

using namespace packed_detail;

/// The words of a stream's coders, read from its end towards `front`; the next one is loaded ahead.
class StreamWords {
 public:
  void start(const std::byte* front, const std::byte* at) {
    front_ = front;
    at_ = at;
    load();
  }
  void renormalise(std::uint32_t& x) {
    if (x >= kLeastState) return;
    if (at_ - front_ < 2) {
      whole_ = false;
      x |= kLeastState;
      return;
    }
    x = x << 16U | next_;
    at_ -= 2;
    load();
  }
  /// Up to 32 bits of a state as they are.
  std::uint32_t bypass(std::uint32_t& x, unsigned bits) {
    std::uint32_t value = 0;
    for (unsigned got = 0; got < bits;) {
      const unsigned take = bits - got < 16 ? bits - got : 16;
      value |= (x & ((1U << take) - 1U)) << got;
      x >>= take;
      renormalise(x);
      got += take;
    }
    return value;
  }
  /// False once a word was missing.
  bool whole() const { return whole_; }
  const std::byte* at() const { return at_; }

 private:
  void load() {
    if (at_ - front_ < 2) return;
    next_ = static_cast<std::uint32_t>(at_[-2]) | static_cast<std::uint32_t>(at_[-1]) << 8U;
  }

  const std::byte* front_ = nullptr;
  const std::byte* at_ = nullptr;
  std::uint32_t next_ = 0;
  bool whole_ = true;
};

/// One value after the other, by the states in turn.
class RansDecoder {
 public:
  /// False where the stream is too short.
  bool start(const std::byte* front, const std::byte* end, unsigned states, unsigned short_flags) {
    StreamStates started;
    if (!started.start(front, end, states, short_flags)) return false;
    for (unsigned s = 0; s < 2; ++s) state_[s] = started.state(s);
    words_.start(front, started.at());
    return true;
  }

  unsigned symbol(unsigned s, const std::uint16_t* table) {
    std::uint32_t& x = state_[s];
    const std::uint32_t slot = x & ((1U << kFrequencyBits) - 1U);
    unsigned found = 0;  // the last entry of the table that is not above `slot`
    for (unsigned j = 1; j < kPackedSymbols; ++j) found += table[j] <= slot ? 1U : 0U;
    const std::uint32_t low = table[found];
    const std::uint32_t high = found + 1 < kPackedSymbols ? table[found + 1] : 1U << kFrequencyBits;
    x = (high - low) * (x >> kFrequencyBits) + slot - low;
    words_.renormalise(x);
    return found;
  }

  /// Up to 32 bits as they are.
  std::uint32_t bypass(unsigned s, unsigned bits) { return words_.bypass(state_[s], bits); }

  std::uint32_t state(unsigned s) const { return state_[s]; }
  const StreamWords& words() const { return words_; }

 private:
  std::uint32_t state_[2] = {kLeastState, kLeastState};
  StreamWords words_;
};

/// Decodes the magnitudes of places 1 to kEndUnit * end - 1 into `magnitudes` by index, which has 513 entries and is
/// zero. Returns how many are not zero; ~0 where the stream is invalid.
inline std::uint32_t decode_magnitudes(const BlockScan& scan, RansDecoder& coder, const CoderContexts& contexts,
                                       unsigned end, std::uint32_t* magnitudes) {
  const unsigned states = states_of(end);
  std::uint32_t nonzero = 0;
  for (unsigned place = 1; place < kEndUnit * end; ++place) {
    const unsigned s = states == 2 ? place & 1U : 0;
    const std::uint16_t* near = scan.neighbour[place];
    const auto value = [&](unsigned n) {
      const std::uint32_t m = magnitudes[near[n]];
      return m < kMostOfNeighbour ? m : kMostOfNeighbour;
    };
    const std::uint32_t t = scan.weight[place] * (value(0) + value(1) + value(2));
    const unsigned level = t < kLevelSums ? scan.level[t] : kPackedLevels - 1;
    const unsigned context = (contexts.bands ? scan.band[place] * kPackedLevels : 0) + level;
    std::uint32_t m = coder.symbol(s, contexts.tables + std::size_t{kPackedSymbols} * context);
    if (m == kEscape) {
      const unsigned length = coder.bypass(s, 5);
      m = kEscape - 1 + (1U << length) + coder.bypass(s, length);
    }
    const unsigned extra = extra_bits(t);
    if (extra > 0) {
      if (m >> (32 - extra) != 0) return ~0U;
      m = m << extra | coder.bypass(s, extra);
    }
    if (m != 0) ++nonzero;
    magnitudes[scan.index[place]] = m;
  }
  if (!coder.words().whole()) return ~0U;
  for (unsigned s = 0; s < states; ++s) {
    if (coder.state(s) >> 16U != 1) return ~0U;
  }
  return nonzero;
}

/// Decodes magnitudes by index (513 entries, zero) and makes the signed values of them, modulo 2^32. `front` begins
/// after the kind; `number_bits` are those of the code. False where the stream is invalid.
inline bool decode_values(const BlockScan& scan, const CoderContexts& contexts, const std::byte* front,
                          const std::byte* stream_end, unsigned end, BitReader& bits, unsigned number_bits,
                          std::uint32_t* magnitudes, std::uint32_t& code) {
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

/// The three passes of the inverse transform, one line of eight after the other.
inline void inverse_transform_lines(float* values) {
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

inline bool decode_transform(const BlockConstants& constants, const BlockScan& scan, const MeanRange& range,
                             const std::byte* stream, std::uint32_t bytes, float* values) {
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

inline bool decode_lattice(const BlockConstants& constants, const BlockScan& scan, const std::byte* stream,
                           std::uint32_t bytes, float* values) {
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

/// As decode_block().
inline bool decode_block(const BlockConstants& constants, const BlockScan& scan, const MeanRange& range,
                         const std::byte* stream, std::uint32_t bytes, float* values) {
  if (bytes < 2) return false;
  switch (static_cast<PackedKind>(static_cast<unsigned>(stream[0]) & 3U)) {
    case PackedKind::mean:
      return decode_mean_alone(constants, range, stream, bytes, values);
    case PackedKind::transform:
      return decode_transform(constants, scan, range, stream, bytes, values);
    case PackedKind::lattice:
      return decode_lattice(constants, scan, stream, bytes, values);
    case PackedKind::raw:
      break;
  }
  return decode_raw(stream, bytes, values);
}

}  // namespace weir::packed_test::plain
