// The host's fast decoder of coded values: it returns and refuses the same as decode_magnitudes() of
// tests/format/packed/plain_decode.h. States and the position in the stream stay in registers, words are read without
// branches, and the nonzero magnitudes come as a list. For little-endian hosts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "format/packed/coefficient_decoder.h"

namespace weir {

/// The nonzero magnitudes of a block, in the order of the scan; entries from `count` on hold anything.
struct NonzeroList {
  std::uint32_t count = 0;
  std::uint16_t index[512];
  std::uint32_t magnitude[512];
};

/// The states of a stream, and the end of its next word.
struct CoderPosition {
  std::uint32_t state[2];
  const std::byte* at;
};

namespace packed_detail {

// Magnitudes lie in 9 x 9 x 9 entries, with a layer of zeros before each axis, so that every neighbour exists.
inline constexpr unsigned kPaddedX = 81;
inline constexpr unsigned kPaddedY = 9;
inline constexpr unsigned kPaddedEntries = 9 * kPaddedX;

/// Weighted sums of neighbours up to this one need no extra bits.
inline constexpr std::uint32_t kPlainSums = 36;

/// Offsets of the tables by sum of neighbours, in entries from the first table: a row of sums for each weight (2, 3 and
/// 6) and band.
struct TableRows {
  static constexpr unsigned kSums = kPlainSums / 2 + 1;
  std::array<std::uint16_t, 3 * kPackedBands * kSums> offset{};
  static constexpr unsigned row(unsigned weight, unsigned band) { return ((weight / 3) * kPackedBands + band) * kSums; }
};

constexpr TableRows make_table_rows(bool bands) {
  TableRows rows;
  for (const unsigned weight : {2U, 3U, 6U}) {
    for (unsigned band = 0; band < kPackedBands; ++band) {
      for (unsigned sum = 0; weight * sum <= kPlainSums; ++sum) {
        const unsigned level = kBlockScan.level[weight * sum] + (bands ? band * kPackedLevels : 0);
        rows.offset[TableRows::row(weight, band) + sum] = static_cast<std::uint16_t>(level * kPackedSymbols);
      }
    }
  }
  return rows;
}

/// The data for the context of a place.
struct PaddedPlace {
  std::uint16_t at = 0;     ///< position in the padded magnitudes
  std::uint16_t row = 0;    ///< row of TableRows
  std::uint8_t weight = 0;  ///< weight of the sum of its neighbours
  std::uint8_t most = 0;    ///< largest sum without extra bits
  std::uint16_t index = 0;  ///< index as in BlockScan
};

constexpr std::array<PaddedPlace, 512> make_padded_places() {
  std::array<PaddedPlace, 512> places;
  for (unsigned p = 0; p < 512; ++p) {
    const unsigned index = kBlockScan.index[p];
    const unsigned weight = kBlockScan.weight[p];
    const unsigned at = ((index >> 6U) + 1) * kPaddedX + ((index >> 3U & 7U) + 1) * kPaddedY + (index & 7U) + 1;
    places[p].at = static_cast<std::uint16_t>(at);
    places[p].row = static_cast<std::uint16_t>(TableRows::row(weight, kBlockScan.band[p]));
    places[p].weight = static_cast<std::uint8_t>(weight);
    places[p].most = static_cast<std::uint8_t>(kPlainSums / weight);
    places[p].index = static_cast<std::uint16_t>(index);
  }
  return places;
}

inline constexpr std::array<PaddedPlace, 512> kPaddedPlaces = make_padded_places();
inline constexpr TableRows kBandRows = make_table_rows(true);
inline constexpr TableRows kResidualRows = make_table_rows(false);

/// Decodes one stream with tables that begin with 0 and rise; readers check that.
class FastCoder {
 public:
  /// Decodes the places below kEndUnit * end, end >= 1. Words begin at `front` or later; the two bytes before `front`
  /// belong to the stream too. Returns false if the stream is invalid.
  bool decode(const CoderContexts& contexts, const std::byte* front, unsigned end, CoderPosition& position) {
    tables_ = contexts.tables;
    front_ = front;
    bool whole;
    if (states_of(end) == 1) {
      whole = contexts.bands ? places<1, true>(end, position) : places<1, false>(end, position);
      return whole && position.state[0] >> 16U == 1;
    }
    whole = contexts.bands ? places<2, true>(end, position) : places<2, false>(end, position);
    return whole && position.state[0] >> 16U == 1 && position.state[1] >> 16U == 1;
  }

  /// Returns the decoded list; empty before decode().
  const NonzeroList& list() const { return list_; }

 private:
  static constexpr std::uint32_t kSlots = 1U << kFrequencyBits;

  // The low bits of a state are kept apart, because they are known two operations before the state.
  struct State {
    std::uint32_t x;
    std::uint32_t slot;
  };

  // Sets the state to `x`, followed by a word if it needs one. The position may move before the front: the caller
  // checks it.
  [[gnu::always_inline]] static void renormalise(State& state, std::uint32_t x, const std::byte*& at) {
    std::uint16_t word;
    std::memcpy(&word, at - 2, sizeof word);
    const std::uint32_t more = x << 16U | word;
    const std::uint32_t more_slot = word & (kSlots - 1U);
    const std::byte* const next = at - 2;
    std::uint32_t slot = x & (kSlots - 1U);
#if defined(__x86_64__) && defined(__GNUC__)
    // Compilers turn these choices into a branch, which is often mispredicted.
    __asm__("cmpl %[least], %[x]\n\tcmovb %[more_slot], %[slot]\n\tcmovb %[more], %[x]\n\tcmovb %[next], %[at]"
            : [x] "+&r"(x), [at] "+&r"(at), [slot] "+&r"(slot)
            : [more] "r"(more), [more_slot] "r"(more_slot), [next] "r"(next), [least] "i"(kLeastState)
            : "cc");
#else
    const bool low = x < kLeastState;
    x = low ? more : x;
    slot = low ? more_slot : slot;
    at = low ? next : at;
#endif
    state = {x, slot};
  }

  [[gnu::always_inline]] static void take(State& state, const std::byte*& at, std::uint32_t low, std::uint32_t high) {
    renormalise(state, (high - low) * (state.x >> kFrequencyBits) + (state.slot - low), at);
  }

  // Returns one bit for each entry of a table: set for the entries above `slot`, which are the last ones; 0 if there is
  // none.
  [[gnu::always_inline]] static std::uint32_t entries_above(const std::uint16_t* table, std::uint32_t slot) {
#if defined(__SSE2__)
    const __m128i wanted = _mm_set1_epi16(static_cast<short>(slot));
    const __m128i low = _mm_loadu_si128(reinterpret_cast<const __m128i*>(table));
    const __m128i high = _mm_loadu_si128(reinterpret_cast<const __m128i*>(table + 8));
    const __m128i above = _mm_packs_epi16(_mm_cmpgt_epi16(low, wanted), _mm_cmpgt_epi16(high, wanted));
    return static_cast<std::uint32_t>(_mm_movemask_epi8(above));
#else
    std::uint32_t above = 0;
    for (unsigned j = 0; j < kPackedSymbols; ++j) above |= (table[j] > slot ? 1U : 0U) << j;
    return above;
#endif
  }

  // Returns the position of the lowest bit that is set.
  [[gnu::always_inline]] static std::size_t lowest_bit(std::uint32_t bits) {
#if defined(__x86_64__) && defined(__GNUC__)
    std::uint64_t place;  // compilers extend the 32-bit result of their own instruction once more
    __asm__("rep bsfq %[bits], %[place]" : [place] "=r"(place) : [bits] "r"(std::uint64_t{bits}) : "cc");
    return place;
#else
    return static_cast<std::size_t>(__builtin_ctz(bits));
#endif
  }

  // Decodes a magnitude without its extra bits.
  [[gnu::always_inline]] bool symbol(State& state, const std::byte*& at, const std::uint16_t* table,
                                     std::uint32_t& m) const {
    const std::uint32_t above = entries_above(table, state.slot);
    if (above == 0) [[unlikely]]
      return escape(state, at, table, m);
    const std::size_t next = lowest_bit(above);
    m = static_cast<std::uint32_t>(next) - 1;
    take(state, at, table[next - 1], table[next]);
    return at >= front_;
  }

  // Returns false if a word is missing.
  [[gnu::always_inline]] bool bypass(State& state, const std::byte*& at, unsigned bits, std::uint32_t& value) const {
    value = state.x & ((1U << bits) - 1U);
    renormalise(state, state.x >> bits, at);
    return at >= front_;
  }

  // Decodes the magnitude of an escape; also takes the escape's symbol.
  [[gnu::always_inline]] bool escape(State& state, const std::byte*& at, const std::uint16_t* table,
                                     std::uint32_t& m) const {
    take(state, at, table[kEscape], kSlots);
    std::uint32_t length;
    if (at < front_ || !bypass(state, at, 5, length)) return false;
    std::uint32_t low = 0;
    std::uint32_t high = 0;
    if (length > 0 && !bypass(state, at, length < 16 ? length : 16, low)) return false;
    if (length > 16 && !bypass(state, at, length - 16, high)) return false;
    m = kEscape - 1 + (1U << length) + (high << 16U | low);
    return true;
  }

  // Decodes a magnitude with extra bits, which it has because its neighbours are large.
  [[gnu::always_inline]] bool large(State& state, const std::byte*& at, const PaddedPlace& where, std::uint32_t sum,
                                    const std::uint16_t* set, std::uint32_t& m) const {
    const std::uint32_t t = where.weight * sum;
    const unsigned level = t < kLevelSums ? kBlockScan.level[t] : kPackedLevels - 1;
    if (!symbol(state, at, set + std::size_t{kPackedSymbols} * level, m)) return false;
    const unsigned extra = extra_bits(t);
    std::uint32_t low;
    if (m >> (32 - extra) != 0 || !bypass(state, at, extra, low)) return false;
    m = m << extra | low;
    return true;
  }

  template <bool kBands>
  [[gnu::always_inline]] bool one(State& state, const std::byte*& at, std::uint32_t& count, const PaddedPlace& where,
                                  std::uint32_t sum) {
    const TableRows& rows = kBands ? kBandRows : kResidualRows;
    std::uint32_t m;
    if (sum > where.most) [[unlikely]] {
      // The offset of the row's first entry is the first table of the place's band.
      if (!large(state, at, where, sum, tables_ + rows.offset[where.row], m)) return false;
    } else if (!symbol(state, at, tables_ + rows.offset[where.row + sum], m)) {
      return false;
    }
    padded_[where.at] = m < kMostOfNeighbour ? m : kMostOfNeighbour;
    list_.index[count] = where.index;
    list_.magnitude[count] = m;
    count += m != 0 ? 1 : 0;
    return true;
  }

  [[gnu::always_inline]] std::uint32_t sum_at(const PaddedPlace& where) const {
    const std::uint32_t* m = padded_ + where.at;
    return m[-static_cast<int>(kPaddedX)] + m[-static_cast<int>(kPaddedY)] + m[-1];
  }

  template <unsigned kStates, bool kBands>
  [[gnu::noinline]] bool places(unsigned end, CoderPosition& position) {
    State s0{position.state[0], position.state[0] & (kSlots - 1U)};
    State s1{position.state[1], position.state[1] & (kSlots - 1U)};
    const std::byte* at = position.at;
    std::uint32_t count = 0;
    State& odd = kStates == 2 ? s1 : s0;
    const PaddedPlace* place = kPaddedPlaces.data();
    // Places 1 to 3 have the places before them as neighbours.
    if (!one<kBands>(odd, at, count, place[1], 0)) return false;
    std::uint32_t sum = padded_[place[1].at];
    if (!one<kBands>(s0, at, count, place[2], sum)) return false;
    sum += padded_[place[2].at];
    if (!one<kBands>(odd, at, count, place[3], sum)) return false;
    const PaddedPlace* const last = place + std::size_t{kEndUnit} * end;
    for (place += 4; place < last; place += 2) {
      if (!one<kBands>(s0, at, count, place[0], sum_at(place[0]))) return false;
      if (!one<kBands>(odd, at, count, place[1], sum_at(place[1]))) return false;
    }
    position.state[0] = s0.x;
    position.state[1] = s1.x;
    position.at = at;
    list_.count = count;
    return true;
  }

  const std::uint16_t* tables_ = nullptr;
  const std::byte* front_ = nullptr;
  std::uint32_t padded_[kPaddedEntries] = {};
  NonzeroList list_;
};

}  // namespace packed_detail
}  // namespace weir
