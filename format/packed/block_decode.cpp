#include "format/packed/block_decode.h"

#include <bit>
#include <cstring>

#include "format/base/simd.h"
#include "format/base/transpose_lanes.h"
#include "format/packed/coefficient_values.h"
#include "format/packed/fast_magnitudes.h"

namespace weir {
namespace {

// Planes of x from `planes` on hold only +0: every sum and difference of their transforms along z and y is +0 too.
WEIR_SIMD void transform_in_lanes(float* values, unsigned planes, float mean, float minimum, float maximum) {
  const Floats8 none{};
  for (unsigned x = 0; x < planes; ++x) {
    Floats8 rows[8];
    for (unsigned y = 0; y < 8; ++y) load_lanes(values + 64 * x + 8 * y, rows[y]);
    transpose_8(rows);
    inverse_transform_8(rows);  // along z, of eight y at once
    transpose_8(rows);
    inverse_transform_8(rows);  // along y
    for (unsigned y = 0; y < 8; ++y) store_lanes(rows[y], values + 64 * x + 8 * y);
  }
  for (unsigned y = 0; y < 8; ++y) {
    Floats8 rows[8];
    for (unsigned x = 0; x < 8; ++x) load_lanes(values + 64 * x + 8 * y, rows[x]);
    inverse_transform_8(rows);  // along x
    for (unsigned x = 0; x < 8; ++x) {
      Floats8 v = (mean - none) + rows[x];
      v = v >= minimum ? v : minimum - none;
      v = v <= maximum ? v : maximum - none;
      store_lanes(v, values + 64 * x + 8 * y);
    }
  }
}

// The signs of a block's nonzero values, in the order of the values: 64 to a word.
class Signs {
 public:
  std::uint32_t of(std::uint32_t n) const { return static_cast<std::uint32_t>(words_[n >> 6U] >> (n & 63U)) & 1U; }

  // Takes `early` bits of the front, from bit `at` on, which the front must have; then `late` bits of the payload.
  void set(const std::byte* front, std::uint32_t at, std::uint32_t early, std::uint32_t late, std::uint32_t payload) {
    std::byte bytes[80] = {};
    const std::uint32_t first = at >> 3U;
    if (early > 0) std::memcpy(bytes, front + first, ((at + early + 7) >> 3U) - first);
    const unsigned shift = at & 7U;
    for (std::uint32_t w = 0; 64 * w < early; ++w) {
      std::uint64_t low;
      std::memcpy(&low, bytes + 8 * w, sizeof low);
      words_[w] = low >> shift | (static_cast<std::uint64_t>(bytes[8 * w + 8]) << 8U) << (56 - shift);
    }
    const std::uint64_t last = late == 32 ? payload : payload & ((1U << late) - 1U);
    const std::uint32_t word = early >> 6U;
    const unsigned offset = early & 63U;
    words_[word] = (words_[word] & ((std::uint64_t{1} << offset) - 1)) | last << offset;
    if (offset > 32) words_[word + 1] = last >> (64 - offset);
  }

 private:
  std::uint64_t words_[9] = {};
};

// Computes coefficients from magnitudes, with the result of coefficient() of block_decode.h.
class Sizes {
 public:
  Sizes(const BlockConstants& constants, float step) : constants_(constants), step_(step) {
    for (unsigned m = 1; m < kSmall; ++m) small_[m] = packed_detail::coefficient(m, constants, step);
  }
  float coefficient(std::uint32_t magnitude, std::uint32_t negative) const {
    if (magnitude >= kSmall) [[unlikely]] {
      return packed_detail::coefficient(negative != 0 ? 0U - magnitude : magnitude, constants_, step_);
    }
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(small_[magnitude]) ^ negative << 31U);
  }

 private:
  static constexpr unsigned kSmall = 16;
  const BlockConstants& constants_;
  float step_;
  float small_[kSmall] = {};
};

// Decodes the same values as decode_values() of tests/format/packed/plain_decode.h, but keeps the nonzero values as a
// list and their signs apart.
class ListedValues {
 public:
  bool decode(const CoderContexts& contexts, const std::byte* front, const std::byte* stream_end, unsigned end,
              BitReader& bits, unsigned number_bits) {
    const auto front_bytes = static_cast<std::uint32_t>(stream_end - front);
    if (end == 0) {
      code_ = bits.read(number_bits);
      return bits.bytes_used() <= front_bytes;
    }
    const unsigned states = states_of(end);
    const unsigned flags = bits.read(states);
    if (bits.bytes_used() > front_bytes) return false;
    const std::byte* const words = front + bits.bytes_used();
    StreamStates started;
    if (!started.start(words, stream_end, states, flags)) return false;
    CoderPosition position{{started.state(0), started.state(1)}, started.at()};
    if (!coder_.decode(contexts, words, end, position)) return false;
    const packed_detail::CodedNumber number =
        packed_detail::read_number(bits, states, position.state[0], position.state[1], list().count, number_bits);
    code_ = number.code;
    if ((bits.bits_used() + number.early + 7) >> 3U > static_cast<std::uint32_t>(position.at - front)) return false;
    signs_.set(front, bits.bits_used(), number.early, list().count - number.early, number.payload);
    return true;
  }

  const NonzeroList& list() const { return coder_.list(); }
  std::uint32_t negative(std::uint32_t n) const { return signs_.of(n); }
  std::uint32_t code() const { return code_; }

 private:
  packed_detail::FastCoder coder_;
  Signs signs_;
  std::uint32_t code_ = 0;
};

bool decode_transform(const BlockConstants& constants, const MeanRange& range, const std::byte* stream,
                      std::uint32_t bytes, float* values) {
  std::int32_t step;
  unsigned number_bits;
  if (!packed_detail::read_step(constants, range, stream, step, number_bits)) return false;
  BitReader bits(stream + 1, bytes - 1);
  const unsigned end = bits.read(5) + 1;
  ListedValues coded;
  if (!coded.decode({constants.tables, true}, stream + 1, stream + bytes, end, bits, number_bits)) return false;
  std::memset(values, 0, 512 * sizeof(float));
  const Sizes sizes(constants, step_size(step));
  const NonzeroList& list = coded.list();
  unsigned most = 0;
  for (std::uint32_t n = 0; n < list.count; ++n) {
    const unsigned index = list.index[n];
    most = most < index ? index : most;
    values[index] = sizes.coefficient(list.magnitude[n], coded.negative(n));
  }
  values_of_coefficients(constants, decode_mean(range, step, coded.code()), (most >> 6U) + 1, values);
  return true;
}

// Calls undo_prediction() with a predictor that is known at compile time.
template <bool kOrdered>
void undo(unsigned predictor, std::uint32_t* codes) {
  switch (predictor) {
    case 0:
      return undo_prediction(0, kOrdered, codes);
    case 1:
      return undo_prediction(1, kOrdered, codes);
    case 2:
      return undo_prediction(2, kOrdered, codes);
    default:
      return undo_prediction(3, kOrdered, codes);
  }
}

bool decode_lattice(const BlockConstants& constants, const std::byte* stream, std::uint32_t bytes, float* values) {
  packed_detail::LatticeHead head;
  if (!packed_detail::read_lattice_head(constants, stream, bytes, head)) return false;
  BitReader bits(head.front, static_cast<std::uint32_t>(stream + bytes - head.front));
  const unsigned end = bits.read(6);
  if (end > 512 / kEndUnit) return false;
  ListedValues coded;
  if (!coded.decode(packed_detail::residual_contexts(constants), head.front, stream + bytes, end, bits,
                    head.base_bits)) {
    return false;
  }
  std::uint32_t codes[512] = {};
  codes[0] = coded.code();
  const NonzeroList& list = coded.list();
  for (std::uint32_t n = 0; n < list.count; ++n) {
    const std::uint32_t sign = 0U - coded.negative(n);
    codes[list.index[n]] = (list.magnitude[n] ^ sign) - sign;
  }
  if (head.kind == LatticeKind::ordered) {
    undo<true>(head.predictor, codes);
  } else {
    undo<false>(head.predictor, codes);
  }
  return packed_detail::values_of_codes(constants, head, codes, values);
}

}  // namespace

void values_of_coefficients(const BlockConstants& constants, float mean, unsigned planes, float* values) {
  transform_in_lanes(values, planes, mean, constants.minimum, constants.maximum);
}

bool decode_block(const BlockConstants& constants, const MeanRange& range, const std::byte* stream, std::uint32_t bytes,
                  float* values) {
  if (bytes < 2) return false;
  switch (static_cast<PackedKind>(static_cast<unsigned>(stream[0]) & 3U)) {
    case PackedKind::mean:
      return packed_detail::decode_mean_alone(constants, range, stream, bytes, values);
    case PackedKind::transform:
      return decode_transform(constants, range, stream, bytes, values);
    case PackedKind::lattice:
      return decode_lattice(constants, stream, bytes, values);
    case PackedKind::raw:
      break;
  }
  return packed_detail::decode_raw(stream, bytes, values);
}

}  // namespace weir
