// The contexts of a block's coded values by rows of eight, which counting them (row_costs.h) and coding them
// (value_encoder.h) share.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/simd.h"
#include "format/packed/block_scan.h"

namespace weir {

/// Rows of eight magnitudes by index, after eight rows of zeros. Magnitudes of floats in order may use all 32 bits.
struct MagnitudeRows {
  alignas(64) std::int32_t padded[8 * 72] = {};
  std::uint64_t live = ~std::uint64_t{0};  ///< bit i not set: row i is zero

  std::int32_t* row(unsigned i) { return padded + std::size_t{8} * (i + 8); }
  const std::int32_t* row(unsigned i) const { return padded + std::size_t{8} * (i + 8); }
  std::uint32_t at(unsigned index) const { return static_cast<std::uint32_t>(padded[64 + index]); }
};

/// The data for contexts, by index. The first four places are not in it: place 0 is not coded, and places 1 to 3 have
/// each other as neighbours.
struct RowPlaces {
  alignas(64) std::int32_t weight[512] = {};
  alignas(64) std::int32_t place[512] = {};         ///< 512 for the first four places
  alignas(64) std::int32_t first_symbol[512] = {};  ///< first symbol of level 0, counted from the first table's
  std::int32_t first_place[64] = {};                ///< the least place of each row
};

/// `bands`: for transformed blocks, which have a set of levels for each band.
constexpr RowPlaces make_row_places(bool bands) {
  RowPlaces rows;
  for (std::int32_t& least : rows.first_place) least = 512;
  for (unsigned place = 0; place < 512; ++place) {
    const unsigned index = kBlockScan.index[place];
    rows.weight[index] = kBlockScan.weight[place];
    rows.place[index] = place < 4 ? 512 : static_cast<std::int32_t>(place);
    rows.first_symbol[index] =
        static_cast<std::int32_t>((bands ? kBlockScan.band[place] : 0U) * kPackedLevels * kPackedSymbols);
    std::int32_t& least = rows.first_place[index / 8];
    least = rows.place[index] < least ? rows.place[index] : least;
  }
  return rows;
}

inline constexpr RowPlaces kTransformPlaces = make_row_places(true);
inline constexpr RowPlaces kLatticePlaces = make_row_places(false);
inline const RowPlaces& row_places(bool bands) { return bands ? kTransformPlaces : kLatticePlaces; }

/// Places by index, as vector lanes load them.
struct PlacesByIndex {
  alignas(64) std::int32_t place[512] = {};
};
constexpr PlacesByIndex make_places_by_index() {
  PlacesByIndex places;
  for (unsigned index = 0; index < 512; ++index) places.place[index] = kBlockScan.place[index];
  return places;
}
inline constexpr PlacesByIndex kPlacesByIndex = make_places_by_index();

namespace packed_detail {

inline constexpr auto kFirstEscape = static_cast<std::int32_t>(kPackedSymbols) - 1;

#ifdef WEIR_SIMD_PATHS
inline bool has_avx512() { return __builtin_cpu_supports("avx512f") != 0; }
#endif

// The lanes of one row, or of two consecutive rows. Each path uses vectors as wide as its instructions, because
// compilers split wider vectors.
struct OneRow {
  using Ints = Ints8;
  using Floats = Floats8;
};
struct TwoRows {
  using Ints = Ints16;
  using Floats = Floats16;
};

// A difference shifted right by 31 has all bits set if it is negative; comparisons of this many lanes are slow.

// Sets all lanes to `value`, hidden from the compiler: so it is made once before a loop, not in each iteration.
template <typename Lanes, typename T>
[[gnu::always_inline]] inline void set_lanes(T value, Lanes& lanes) {
  lanes = Lanes{} + value;
#ifdef WEIR_SIMD_PATHS
  if constexpr (sizeof lanes == 64) {
    asm("" : "+v"(lanes));  // it stays in its register
    return;
  }
#endif
  asm("" : "+m"(lanes));
}

// Finds contexts from the weighted sums of a value's neighbours, with floats: a float's exponent is the whole part of
// its logarithm. Rounding does not change the result, because a sum below a threshold is below it by at least one part
// in 18 * 2^16.
template <typename Lanes>
class Contexts {
 public:
  using Ints = typename Lanes::Ints;
  using Floats = typename Lanes::Floats;
  [[gnu::always_inline]] inline Contexts() {
    set_lanes(2.0F / 3, two_thirds_);
    set_lanes(1.0F, one_);
    set_lanes(1.0F / 18, eighteenth_);
    set_lanes(static_cast<std::int32_t>(kPackedLevels) - 1, last_level_);
    set_lanes(16, most_extra_);
    set_lanes(36, no_extra_);
    set_lanes(127, exponent_bias_);
  }
  // Computes log2 of `v`, which is at least 1, rounded down.
  [[gnu::always_inline]] inline void log2_of(const Ints& v, Ints& log2) const {
    exponent_of(__builtin_convertvector(v, Floats), log2);
  }
  // Computes BlockScan::level, floor(log2((1 + 2 t / 3)^3)), at most the last level; and extra_bits(), floor(log2(t /
  // 18)) for t above 36, at most 16.
  [[gnu::always_inline]] inline void find(const Ints& t, Ints& level, Ints& extra) const {
    const auto sum = __builtin_convertvector(t, Floats);
    const Floats base = sum * two_thirds_ + one_;
    exponent_of(base * base * base, level);
    level = level < last_level_ ? level : last_level_;
    exponent_of(sum * eighteenth_, extra);
    extra = extra < most_extra_ ? extra : most_extra_;
    extra &= (no_extra_ - t) >> 31;
  }

 private:
  [[gnu::always_inline]] inline void exponent_of(const Floats& v, Ints& exponent) const {
    __builtin_memcpy(&exponent, &v, sizeof exponent);
    exponent = (exponent >> 23) - exponent_bias_;
  }

  Floats two_thirds_, one_, eighteenth_;
  Ints last_level_, most_extra_, no_extra_, exponent_bias_;
};

// Masks of the lanes that have a neighbour before them.
template <typename Lanes>
struct Before {
  typename Lanes::Ints in_row{};      // all bits set except in the first lane of each row
  typename Lanes::Ints second_row{};  // all bits set in the second row
  [[gnu::always_inline]] inline Before() {
    constexpr unsigned kLanes = sizeof(typename Lanes::Ints) / sizeof(std::int32_t);
    for (unsigned l = 0; l < kLanes; ++l) {
      in_row[l] = l % 8 == 0 ? 0 : -1;
      second_row[l] = l < 8 ? 0 : -1;
    }
  }
};

// Loads the magnitudes before those of row `row` along each axis; 0 if there are none.
template <typename Lanes>
[[gnu::always_inline]] inline void load_neighbours(const std::int32_t* at, unsigned row, const Before<Lanes>& before,
                                                   typename Lanes::Ints& up, typename Lanes::Ints& left,
                                                   typename Lanes::Ints& back) {
  load_lanes(at - 64, up);
  load_lanes(at - 8, left);
  if (row % 8 == 0) left &= before.second_row;  // for j = 0 the row before belongs to another i
  load_lanes(at - 1, back);
  back &= before.in_row;
}

}  // namespace packed_detail
}  // namespace weir
