#include "format/packed/value_encoder.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "format/base/simd.h"

namespace weir {
namespace {

using packed_detail::Before;
using packed_detail::Contexts;
using packed_detail::kFirstEscape;
using packed_detail::load_neighbours;
using packed_detail::OneRow;
using packed_detail::TwoRows;

constexpr std::uint32_t kTotal = 1U << kFrequencyBits;

// The inverse of f is ceil(2^44 / f): x * inverse >> 44 is x / f for every x below f * 2^20. A state is reduced to
// below that before it takes a symbol of frequency f.
static_assert(kFrequencyBits <= 12, "a state below 2^32 is below f * 2^20 then");
constexpr unsigned kInverseBits = 44;

// The most words: for each value a symbol, five bits of an escape, and two halves of raw bits twice.
constexpr std::size_t kMostWords = 512 * 6;

// The symbol and extra bits of each value, by index.
struct CodedRows {
  alignas(64) std::int32_t symbol[512];  // counted from the first table's first symbol
  alignas(64) std::int32_t extra[512];   // low bits that are stored raw
  std::int32_t with_extra = 0;           // number of values with extra bits, except the first four
};

template <typename Ints>
[[gnu::always_inline]] inline void limit_neighbours(Ints& magnitudes) {
  // Magnitudes of 32 bits look negative.
  constexpr auto kMost = static_cast<std::int32_t>(kMostOfNeighbour);
  const Ints none{};
  const Ints large = (magnitudes >> 31) | ((kMost - magnitudes) >> 31);
  magnitudes = (magnitudes & ~large) | ((none + kMost) & large);
}

// Finds the symbols of all places except the first four, and only of those below `limit`.
template <typename Lanes>
[[gnu::always_inline]] inline void find_symbols(const RowPlaces& places, const std::int32_t* padded, std::int32_t limit,
                                                CodedRows& coded) {
  using Ints = typename Lanes::Ints;
  constexpr unsigned kRows = sizeof(Ints) / (8 * sizeof(std::int32_t));
  const Before<Lanes> before;
  const Contexts<Lanes> contexts;
  const Ints none{};
  Ints with{};
  for (unsigned row = 0; row < 64; row += kRows) {
    if (places.first_place[row] >= limit && places.first_place[row + kRows - 1] >= limit) continue;
    const std::int32_t* at = padded + 8 * (row + 8);
    Ints m, up, left, back, weight, symbol;
    load_lanes(at, m);
    load_neighbours<Lanes>(at, row, before, up, left, back);
    limit_neighbours(up);
    limit_neighbours(left);
    limit_neighbours(back);
    load_lanes(places.weight + 8 * row, weight);
    load_lanes(places.first_symbol + 8 * row, symbol);
    const Ints t = (up + left + back) * weight;
    Ints level;
    Ints extra;
    contexts.find(t, level, extra);
    const Ints high = m >> extra;
    const Ints plain = ((high - kFirstEscape) >> 31) & ~(m >> 31);  // all bits set if there is no escape
    symbol += 16 * level + ((high & plain) | ((none + kFirstEscape) & ~plain));
    store_lanes(symbol, coded.symbol + 8 * row);
    store_lanes(extra, coded.extra + 8 * row);
    with += -extra >> 31;
  }
  for (unsigned l = 0; l < sizeof(Ints) / sizeof(std::int32_t); ++l) coded.with_extra -= with[l];
}

#ifdef WEIR_SIMD_PATHS
__attribute__((target("avx512f"))) void symbols_512(const RowPlaces& places, const std::int32_t* padded,
                                                    std::int32_t limit, CodedRows& coded) {
  find_symbols<TwoRows>(places, padded, limit, coded);
}

__attribute__((target_clones("avx2", "default"))) void symbols_256(const RowPlaces& places, const std::int32_t* padded,
                                                                   std::int32_t limit, CodedRows& coded) {
  find_symbols<OneRow>(places, padded, limit, coded);
}

void symbols_of(const RowPlaces& places, const std::int32_t* padded, std::int32_t limit, CodedRows& coded) {
  static const bool wide = packed_detail::has_avx512();
  (wide ? symbols_512 : symbols_256)(places, padded, limit, coded);
}
#else
void symbols_of(const RowPlaces& places, const std::int32_t* padded, std::int32_t limit, CodedRows& coded) {
  find_symbols<OneRow>(places, padded, limit, coded);
}
#endif

// The signs of coded values, in the order of the values.
class SignBits {
 public:
  SignBits(const SignedRows& values, unsigned places) {
    std::uint64_t held = 0;
    std::uint32_t bits = 0;  // bits in `held`
    std::uint32_t* out = words_.data();
    const auto add = [&](unsigned place) {
      const unsigned index = kBlockScan.index[place];
      const std::uint32_t coded = values.magnitudes.at(index) != 0 ? 1 : 0;
      held |= std::uint64_t{values.signs[index] >> 31U & coded} << bits;
      bits += coded;
    };
    for (unsigned first = 0; first < places; first += kEndUnit) {
      for (unsigned place = std::max(first, 1U); place < first + kEndUnit; ++place) add(place);
      *out = static_cast<std::uint32_t>(held);
      const unsigned full = bits >= 32 ? 1 : 0;  // unpredictable, so it is added without a branch
      out += full;
      held >>= 32U * full;
      bits -= 32U * full;
    }
    *out = static_cast<std::uint32_t>(held);
    count_ = static_cast<std::uint32_t>(32 * (out - words_.data())) + bits;
  }
  std::uint32_t count() const { return count_; }
  /// Returns at most 32 signs from `first` on, the first one in the lowest bit.
  std::uint32_t bits(std::uint32_t first, std::uint32_t count) const {
    const std::uint64_t two = words_[first / 32] | std::uint64_t{words_[first / 32 + 1]} << 32U;
    return static_cast<std::uint32_t>(two >> (first % 32) & ((std::uint64_t{1} << count) - 1));
  }

 private:
  static_assert(kEndUnit <= 32, "what is held has room for as many");
  std::array<std::uint32_t, 512 / 32 + 2> words_{};
  std::uint32_t count_ = 0;
};

class BitWriter {
 public:
  /// Writes to bytes that are zero.
  explicit BitWriter(std::span<std::byte> out) : out_(out) {}
  /// Writes the low `bits` of `value`. Bits that `out` has no room for are only counted.
  void write(std::uint32_t value, unsigned bits) {
    std::uint64_t shifted = (value & ((std::uint64_t{1} << bits) - 1)) << (at_ % 8);
    std::size_t byte = at_ / 8;
    at_ += bits;
    if (byte + sizeof shifted <= out_.size()) {
      std::uint64_t before;
      std::memcpy(&before, out_.data() + byte, sizeof before);
      shifted |= before;
      std::memcpy(out_.data() + byte, &shifted, sizeof shifted);
      return;
    }
    for (; shifted != 0 && byte < out_.size(); ++byte, shifted >>= 8U) {
      out_[byte] |= static_cast<std::byte>(shifted & 0xFFU);
    }
  }
  std::uint32_t bytes() const { return static_cast<std::uint32_t>((at_ + 7) / 8); }

 private:
  std::span<std::byte> out_;
  std::size_t at_ = 0;
};

}  // namespace

// The words in the order in which they are made, which is the order of their addresses.
class ValueEncoder::Words {
 public:
  void put_symbol(std::uint32_t& x, const Symbol& symbol) {
    put_word(x, symbol.most - x);
    x += static_cast<std::uint32_t>(x * symbol.inverse >> kInverseBits) * symbol.complement + symbol.low;
  }
  /// Puts up to 16 bits uncoded. The decoder shifts right and then reads a word if the state is below the least.
  void put_raw(std::uint32_t& x, std::uint32_t value, unsigned bits) {
    put_word(x, 0xFFFFFFFFU - (std::uint64_t{x} << bits));
    x = x << bits | value;
  }
  /// Puts the parts of an escape. The decoder reads in reverse order, so the length is put last.
  void put_escape(std::uint32_t& x, std::uint32_t high) {
    const std::uint32_t over = high - (kEscape - 1);
    const auto length = static_cast<unsigned>(std::bit_width(over) - 1);
    const std::uint32_t rest = over - (1U << length);
    if (length > 16) put_raw(x, rest >> 16U, length - 16);
    put_raw(x, rest & 0xFFFFU, std::min(length, 16U));
    put_raw(x, length, 5);
  }
  std::span<const std::uint16_t> all() const { return {words_.data(), count_}; }

 private:
  // Whether a word must be written is unpredictable: it is always stored, and counted if `left` is negative.
  void put_word(std::uint32_t& x, std::uint64_t left) {
    words_[count_] = static_cast<std::uint16_t>(x & 0xFFFFU);
    count_ += left >> 63U;
    x >>= (left >> 59U) & 16U;
  }

  std::array<std::uint16_t, kMostWords> words_;
  std::size_t count_ = 0;
};

unsigned end_of(const MagnitudeRows& magnitudes) {
  for (unsigned place = 512; place > 1; --place) {
    if (magnitudes.at(kBlockScan.index[place - 1]) != 0) return (place + kEndUnit - 1) / kEndUnit;
  }
  return 0;
}

ValueEncoder::ValueEncoder(const std::uint16_t* tables, Kind kind) : bands_(kind == Kind::transform) {
  const unsigned first = bands_ ? 0 : kPackedBands * kPackedLevels;
  for (unsigned context = 0; context < (bands_ ? kPackedBands : 1) * kPackedLevels; ++context) {
    const std::uint16_t* table = tables + std::size_t{kPackedSymbols} * (first + context);
    for (unsigned s = 0; s < kPackedSymbols; ++s) {
      const std::uint32_t end = s + 1 < kPackedSymbols ? table[s + 1] : kTotal;
      Symbol& symbol = symbols_[std::size_t{kPackedSymbols} * context + s];
      const std::uint32_t frequency = end - table[s];
      symbol.low = table[s];
      symbol.complement = kTotal - frequency;
      if (frequency == 0) continue;
      symbol.most = (std::uint64_t{frequency} << (32U - kFrequencyBits)) - 1;
      symbol.inverse = ((std::uint64_t{1} << kInverseBits) + frequency - 1) / frequency;
    }
  }
}

// Goes from the last place to the first; within a place, puts first what is decoded last.
template <unsigned States>
void ValueEncoder::put_values(const StreamFront& front, const MagnitudeRows& magnitudes, std::uint32_t (&states)[2],
                              Words& words) const {
  CodedRows coded;
  const RowPlaces& places = row_places(bands_);
  symbols_of(places, magnitudes.padded, static_cast<std::int32_t>(kEndUnit * front.end), coded);
  std::uint32_t before = 0;
  for (unsigned place = 1; place < 4; ++place) {
    const unsigned index = kBlockScan.index[place];
    const std::uint32_t m = magnitudes.at(index);
    const std::uint32_t t = kBlockScan.weight[place] * before;
    const unsigned level = t < kLevelSums ? kBlockScan.level[t] : kPackedLevels - 1;
    const unsigned extra = extra_bits(t);
    coded.extra[index] = static_cast<std::int32_t>(extra);
    coded.symbol[index] =
        places.first_symbol[index] + static_cast<std::int32_t>(kPackedSymbols * level + std::min(m >> extra, kEscape));
    before += std::min(m, kMostOfNeighbour);
  }
  // If many values have raw bits, a branch for them costs more than writing none.
  const bool many_raw = coded.with_extra > 64;
  const auto put = [&](std::uint32_t& state, unsigned place) {
    const unsigned index = kBlockScan.index[place];
    const std::int32_t symbol = coded.symbol[index];
    const auto extra = static_cast<unsigned>(coded.extra[index]);
    const bool escapes = (static_cast<unsigned>(symbol) & (kPackedSymbols - 1)) == kEscape;
    if (many_raw || extra != 0 || escapes) {
      const std::uint32_t m = magnitudes.at(index);
      words.put_raw(state, m & ((1U << extra) - 1U), extra);
      if (escapes) words.put_escape(state, m >> extra);
    }
    words.put_symbol(state, symbols_[static_cast<std::size_t>(symbol)]);
  };
  // The states of even and odd places, if there are two, stay in registers.
  std::uint32_t even = states[0];
  std::uint32_t odd = states[1];
  unsigned place = kEndUnit * front.end - 1;
  for (; place > 1; place -= 2) {
    put(States == 2 ? odd : even, place);
    put(even, place - 1);
  }
  put(States == 2 ? odd : even, place);
  states[0] = even;
  states[1] = odd;
}

bool ValueEncoder::encode(const StreamFront& front, const SignedRows& values, std::span<std::byte> out,
                          StreamSize* size) const {
  std::fill(out.begin(), out.end(), std::byte{0});
  BitWriter bits(out);
  bits.write(front.end_bits == 5 ? front.end - 1 : front.end, front.end_bits);
  if (front.end == 0) {
    bits.write(front.number, front.number_bits);
    if (size != nullptr) *size = {bits.bytes(), 0};
    return bits.bytes() <= out.size();
  }
  const unsigned states = states_of(front.end);
  const unsigned capacity = 16 * states;
  const SignBits signs(values, kEndUnit * front.end);
  const std::uint32_t late = std::min(signs.count(), capacity);
  const unsigned moved = std::min(capacity - late, front.number_bits);
  std::uint32_t payload = signs.bits(signs.count() - late, late);
  if (moved > 0) {
    const std::uint32_t low = moved == 32 ? front.number : front.number & ((1U << moved) - 1U);
    payload |= low << late;
  }

  std::uint32_t state[2] = {kLeastState | (payload & 0xFFFFU), kLeastState | payload >> 16U};
  Words words;
  if (states == 2) {
    put_values<2>(front, values.magnitudes, state, words);
  } else {
    put_values<1>(front, values.magnitudes, state, words);
  }

  std::array<unsigned, 2> state_bytes{};
  for (unsigned s = 0; s < states; ++s) {
    state_bytes[s] = state[s] >> 24U == 0 ? 3 : 4;
    bits.write(state_bytes[s] == 3 ? 1 : 0, 1);
  }
  bits.write(moved == 32 ? 0 : front.number >> moved, front.number_bits - moved);
  for (std::uint32_t i = 0; i + late < signs.count(); i += 32) {
    const std::uint32_t some = std::min(32U, signs.count() - late - i);
    bits.write(signs.bits(i, some), some);
  }
  const std::size_t back = words.all().size_bytes() + state_bytes[0] + state_bytes[1];
  if (size != nullptr) *size = {bits.bytes(), static_cast<std::uint32_t>(back)};
  if (bits.bytes() + back > out.size()) return false;
  std::size_t at = out.size() - back;
  std::memcpy(out.data() + at, words.all().data(), words.all().size_bytes());
  at += words.all().size_bytes();
  for (unsigned s = states; s > 0; --s) {
    for (unsigned b = 0; b < state_bytes[s - 1]; ++b)
      out[at++] = static_cast<std::byte>(state[s - 1] >> (8 * b) & 0xFFU);
  }
  return true;
}

}  // namespace weir
