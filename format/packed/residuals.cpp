#include "format/packed/residuals.h"

#include <algorithm>

#include "format/base/doubles8.h"
#include "format/packed/lattice_codes.h"

namespace weir {
namespace {

// The residuals of the 3-D Lorenzo predictor: the codes after differences along each axis in turn.
WEIR_SIMD void difference_all(const std::uint32_t* codes, std::uint32_t* residuals) {
  for (unsigned x = 0; x < 512; x += 64) {
    Words8 beside{};
    for (unsigned i = x; i < x + 64; i += 8) {
      Words8 along_x;
      __builtin_memcpy(&along_x, codes + i, sizeof along_x);
      if (x > 0) {
        Words8 left;
        __builtin_memcpy(&left, codes + i - 64, sizeof left);
        along_x -= left;
      }
      const Words8 along_y = along_x - beside;
      beside = along_x;
      const Words8 row = along_y - __builtin_shufflevector(along_y, Words8{}, 8, 0, 1, 2, 3, 4, 5, 6);
      __builtin_memcpy(residuals + i, &row, sizeof row);
    }
  }
  residuals[0] = 0;
}

// The rows of codes beside a row. Sums of codes below 2^24 fit 32 bits; sums of ordered codes are exact as doubles.
template <typename Lanes>
struct CodeRow {
  Lanes left{};     // the row at x - 1
  Lanes up{};       // the row at y - 1
  Lanes left_up{};  // the row at x - 1, y - 1
  bool has_left;
  bool has_up;
};

[[gnu::always_inline]] inline void load_codes(const std::uint32_t* at, Ints8& row) {
  __builtin_memcpy(&row, at, sizeof row);
}

[[gnu::always_inline]] inline void load_codes(const std::uint32_t* at, Doubles8& row) {
  Ints8 codes;
  load_codes(at, codes);
  row = Doubles8(codes);
}

// Moves lane z - 1 to lane z; lane 0 keeps its value.
[[gnu::always_inline]] inline void shift_up(const Ints8& row, Ints8& shifted) {
  shifted = __builtin_shufflevector(row, row, 0, 0, 1, 2, 3, 4, 5, 6);
}
[[gnu::always_inline]] inline void shift_up(const Doubles8& row, Doubles8& shifted) {
  shifted.high = __builtin_shufflevector(row.low, row.high, 3, 4, 5, 6);
  shifted.low = __builtin_shufflevector(row.low, row.low, 0, 0, 1, 2);
}

// Replaces lane 0 of `row` by lane 0 of `other`.
[[gnu::always_inline]] inline void set_first(const Ints8& other, Ints8& row) {
  row = __builtin_shufflevector(other, row, 0, 9, 10, 11, 12, 13, 14, 15);
}
[[gnu::always_inline]] inline void set_first(const Doubles8& other, Doubles8& row) {
  row.low = __builtin_shufflevector(other.low, row.low, 0, 5, 6, 7);
}

// Replaces each lane by the lesser, or the greater, of itself and the other row's.
[[gnu::always_inline]] inline void lower_to(const Ints8& other, Ints8& row) { row = other < row ? other : row; }
[[gnu::always_inline]] inline void lower_to(const Doubles8& other, Doubles8& row) {
  row = select(other < row, other, row);
}
[[gnu::always_inline]] inline void raise_to(const Ints8& other, Ints8& row) { row = row < other ? other : row; }
[[gnu::always_inline]] inline void raise_to(const Doubles8& other, Doubles8& row) {
  row = select(row < other, other, row);
}

// Computes floor(sum / count) of 2 or 3 codes.
[[gnu::always_inline]] inline void floor_mean(const Ints8& sum, int count, Ints8& mean) {
  mean = count == 3 ? sum / 3 : sum >> 1;
}

[[gnu::always_inline]] inline void floor_mean(const Doubles8& sum, int count, Doubles8& mean) {
  const Doubles8 within = (sum + 0.5) * (1.0 / count);  // at least a sixth away from whole numbers
  Ints8 whole;
  narrow(within, whole);
  mean = Doubles8(whole);
  mean = select(mean > within, mean - 1.0, mean);
}

// Subtracts the predictions from codes, modulo 2^32.
[[gnu::always_inline]] inline void take_away(const Ints8& predicted, Words8& row) {
  row -= reinterpret_cast<const Words8&>(predicted);
}

[[gnu::always_inline]] inline void take_away(const Doubles8& predicted, Words8& row) {
  constexpr double kWholes = 0x1.8p52;  // the sum's mantissa ends in the whole number
  const Doubles8 sum = predicted + kWholes;
  Longs8 bits;
  __builtin_memcpy(&bits, &sum, sizeof bits);
  Ints8 whole;
  narrow(bits, whole);
  take_away(whole, row);
}

struct PredictMean {
  // The mean of the neighbours; `has_back` tells whether there is one at z - 1.
  template <typename Lanes>
  [[gnu::always_inline]] static void predict(const CodeRow<Lanes>& beside, const Lanes& back, bool has_back,
                                             Lanes& mean) {
    Lanes sum{};
    if (beside.has_left) sum += beside.left;
    if (beside.has_up) sum += beside.up;
    if (has_back) sum += back;
    const int count = (beside.has_left ? 1 : 0) + (beside.has_up ? 1 : 0) + (has_back ? 1 : 0);
    mean = sum;
    if (count > 1) floor_mean(sum, count, mean);
  }
};

struct PredictLeast {
  template <typename Lanes>
  [[gnu::always_inline]] static void predict(const CodeRow<Lanes>& beside, const Lanes& back, bool has_back,
                                             Lanes& least) {
    least = has_back ? back : beside.has_left ? beside.left : beside.up;
    if (beside.has_left) lower_to(beside.left, least);
    if (beside.has_up) lower_to(beside.up, least);
  }
};

// The median of three planes.
struct PredictMedian {
  template <typename Lanes>
  [[gnu::always_inline]] static void predict(const CodeRow<Lanes>& beside, const Lanes& back, bool has_back,
                                             Lanes& median) {
    Lanes left_back;
    Lanes up_back;
    shift_up(beside.left, left_back);
    shift_up(beside.up, up_back);
    const Lanes a = beside.left + beside.up - beside.left_up;
    const Lanes b = beside.left + back - left_back;
    const Lanes c = beside.up + back - up_back;
    if (!has_back) {
      median = beside.has_left && beside.has_up ? a : beside.has_left ? beside.left : beside.up;
    } else if (beside.has_left && beside.has_up) {
      Lanes low = a;
      Lanes high = a;
      lower_to(b, low);
      raise_to(b, high);
      median = c;
      raise_to(low, median);
      lower_to(high, median);
    } else {
      median = beside.has_left ? b : beside.has_up ? c : back;
    }
  }
};

// Computes the residuals of one predictor, a row of codes at a time.
template <typename Predictor, typename Lanes>
[[gnu::always_inline]] inline void predict_rows(const std::uint32_t* codes, std::uint32_t* residuals) {
  for (unsigned i = 0; i < 512; i += 8) {
    CodeRow<Lanes> beside{.has_left = i >= 64, .has_up = i % 64 != 0};
    Lanes row;
    load_codes(codes + i, row);
    if (beside.has_left) load_codes(codes + i - 64, beside.left);
    if (beside.has_up) load_codes(codes + i - 8, beside.up);
    if (beside.has_left && beside.has_up) load_codes(codes + i - 72, beside.left_up);
    Lanes back;
    shift_up(row, back);
    Lanes with_back;
    Lanes without;
    Predictor::predict(beside, back, true, with_back);
    Predictor::predict(beside, back, false, without);
    set_first(without, with_back);
    Words8 residual;
    __builtin_memcpy(&residual, codes + i, sizeof residual);
    take_away(with_back, residual);
    __builtin_memcpy(residuals + i, &residual, sizeof residual);
  }
  residuals[0] = 0;
}

WEIR_SIMD void predict_means(const std::uint32_t* codes, std::uint32_t* residuals) {
  predict_rows<PredictMean, Ints8>(codes, residuals);
}
WEIR_SIMD void predict_leasts(const std::uint32_t* codes, std::uint32_t* residuals) {
  predict_rows<PredictLeast, Ints8>(codes, residuals);
}
WEIR_SIMD void predict_medians(const std::uint32_t* codes, std::uint32_t* residuals) {
  predict_rows<PredictMedian, Ints8>(codes, residuals);
}
WEIR_SIMD void predict_ordered_means(const std::uint32_t* codes, std::uint32_t* residuals) {
  predict_rows<PredictMean, Doubles8>(codes, residuals);
}
WEIR_SIMD void predict_ordered_medians(const std::uint32_t* codes, std::uint32_t* residuals) {
  predict_rows<PredictMedian, Doubles8>(codes, residuals);
}

// Estimates the bits of residuals: sums the bit lengths of three times each magnitude. Three times a magnitude is 0,
// with no bits, or at least 2, with two bits more than the exponent of its half.
WEIR_SIMD std::uint32_t rough_bits(const std::uint32_t* residuals) {
  constexpr std::int32_t kNone = 127 - 2;  // the biased exponent minus the bits
  const Ints8 none = Ints8{} + kNone;
  Ints8 sum{};
  for (unsigned i = 0; i < 512; i += 8) {
    Words8 r;
    __builtin_memcpy(&r, residuals + i, sizeof r);
    const Words8 size = r >> 31 != 0 ? 0U - r : r;
    const Words8 m = 3U * size;
    Words8 half = m >> 1;
    half &= ~(half >> 1);  // keeps it from being rounded up to the next power of two
    const auto f = __builtin_convertvector(reinterpret_cast<Ints8&>(half), Floats8);
    Ints8 exponent;
    __builtin_memcpy(&exponent, &f, sizeof exponent);
    exponent >>= 23;
    sum += exponent > none ? exponent : none;
  }
  std::uint32_t bits = 0;
  for (int l = 0; l < 8; ++l) bits += static_cast<std::uint32_t>(sum[l] - 64 * kNone);
  return bits;
}

WEIR_SIMD ResidualSizes fill_rows(const std::uint32_t* residuals, MagnitudeRows& magnitudes) {
  const Ints8 none{};
  Ints8 last{};
  Words8 bits{};
  for (unsigned row = 0; row < 64; ++row) {
    Words8 r;
    __builtin_memcpy(&r, residuals + 8 * row, sizeof r);
    const Words8 m = r >> 31 != 0 ? 0U - r : r;
    __builtin_memcpy(magnitudes.row(row), &m, sizeof m);
    bits |= m;
    Ints8 place;
    __builtin_memcpy(&place, kPlacesByIndex.place + 8 * row, sizeof place);
    place = m == 0 ? none : place;
    last = place > last ? place : last;
  }
  ResidualSizes sizes;
  for (int l = 0; l < 8; ++l) {
    sizes.last_place = std::max(sizes.last_place, static_cast<unsigned>(last[l]));
    sizes.bits |= bits[l];
  }
  return sizes;
}

}  // namespace

void residuals_of(const BlockCodes& codes, unsigned predictor, bool ordered, BlockCodes& residuals) {
  switch (predictor) {
    case 0:
      return difference_all(codes.data(), residuals.data());
    case 1:
      return (ordered ? predict_ordered_means : predict_means)(codes.data(), residuals.data());
    case 2:
      return predict_leasts(codes.data(), residuals.data());
    default:
      return (ordered ? predict_ordered_medians : predict_medians)(codes.data(), residuals.data());
  }
}

unsigned best_predictor(const BlockCodes& codes, bool ordered, BlockCodes& residuals) {
  unsigned best = 0;
  std::uint32_t least = ~0U;
  BlockCodes tried;
  for (unsigned predictor = 0; predictor < kPredictors; ++predictor) {
    residuals_of(codes, predictor, ordered, tried);
    const std::uint32_t bits = rough_bits(tried.data());
    if (bits >= least) continue;
    least = bits;
    best = predictor;
    residuals = tried;
  }
  return best;
}

ResidualSizes fill_magnitudes(const BlockCodes& residuals, MagnitudeRows& magnitudes) {
  return fill_rows(residuals.data(), magnitudes);
}

}  // namespace weir
