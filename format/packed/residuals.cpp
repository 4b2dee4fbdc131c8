#include "format/packed/residuals.h"

#include <algorithm>

#include "format/base/simd.h"
#include "format/packed/block_scan.h"
#include "format/packed/lattice_codes.h"

namespace weir {
namespace {

// The 3-D Lorenzo predictor's: what is left of the codes after differences along each axis in turn.
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

// A row of codes, and those beside it.
struct CodeRow {
  Ints8 left;     // of x - 1
  Ints8 up;       // of y - 1
  Ints8 left_up;  // of both
  bool has_left;
  bool has_up;
};

[[gnu::always_inline]] inline void load_codes(const std::uint32_t* at, Ints8& row) {
  __builtin_memcpy(&row, at, sizeof row);
}

// Lane z has what lane z - 1 had, lane 0 keeps its own.
[[gnu::always_inline]] inline void shift_up(const Ints8& row, Ints8& shifted) {
  shifted = __builtin_shufflevector(row, row, 0, 0, 1, 2, 3, 4, 5, 6);
}

// floor(sum / (1 + has_left + has_up)) of neighbours where there is one at z - 1, else without it.
[[gnu::always_inline]] inline void predict_mean(const CodeRow& beside, const Ints8& back, bool has_back, Ints8& mean) {
  Ints8 sum{};
  if (beside.has_left) sum += beside.left;
  if (beside.has_up) sum += beside.up;
  if (has_back) sum += back;
  const int count = (beside.has_left ? 1 : 0) + (beside.has_up ? 1 : 0) + (has_back ? 1 : 0);
  mean = count == 3 ? sum / 3 : count == 2 ? sum >> 1 : sum;
}

[[gnu::always_inline]] inline void predict_least(const CodeRow& beside, const Ints8& back, bool has_back,
                                                 Ints8& least) {
  least = has_back ? back : beside.has_left ? beside.left : beside.up;
  if (beside.has_left) least = beside.left < least ? beside.left : least;
  if (beside.has_up) least = beside.up < least ? beside.up : least;
}

[[gnu::always_inline]] inline void predict_planes(const CodeRow& beside, const Ints8& back, bool has_back,
                                                  Ints8& median) {
  Ints8 left_back;
  Ints8 up_back;
  shift_up(beside.left, left_back);
  shift_up(beside.up, up_back);
  const Ints8 a = beside.left + beside.up - beside.left_up;
  const Ints8 b = beside.left + back - left_back;
  const Ints8 c = beside.up + back - up_back;
  if (!has_back) {
    median = beside.has_left && beside.has_up ? a : beside.has_left ? beside.left : beside.up;
  } else if (beside.has_left && beside.has_up) {
    const Ints8 low = a < b ? a : b;
    const Ints8 high = a < b ? b : a;
    median = c < low ? low : c;
    median = median > high ? high : median;
  } else {
    median = beside.has_left ? b : beside.has_up ? c : back;
  }
}

using PredictRow = void (*)(const CodeRow&, const Ints8&, bool, Ints8&);

// Of codes below 2^24, a row of them at once: sums fit 32 bits.
template <PredictRow predict_row>
[[gnu::always_inline]] inline void predict_rows(const std::uint32_t* codes, std::uint32_t* residuals) {
  const Ints8 none{};
  const Ints8 first = {-1, 0, 0, 0, 0, 0, 0, 0};
  for (unsigned i = 0; i < 512; i += 8) {
    CodeRow beside{none, none, none, i >= 64, i % 64 != 0};
    Ints8 row;
    load_codes(codes + i, row);
    if (beside.has_left) load_codes(codes + i - 64, beside.left);
    if (beside.has_up) load_codes(codes + i - 8, beside.up);
    if (beside.has_left && beside.has_up) load_codes(codes + i - 72, beside.left_up);
    Ints8 back;
    shift_up(row, back);
    Ints8 with_back;
    Ints8 without;
    predict_row(beside, back, true, with_back);
    predict_row(beside, back, false, without);
    row -= (with_back & ~first) | (without & first);
    __builtin_memcpy(residuals + i, &row, sizeof row);
  }
  residuals[0] = 0;
}

WEIR_SIMD void predict_means(const std::uint32_t* codes, std::uint32_t* residuals) {
  predict_rows<predict_mean>(codes, residuals);
}
WEIR_SIMD void predict_leasts(const std::uint32_t* codes, std::uint32_t* residuals) {
  predict_rows<predict_least>(codes, residuals);
}
WEIR_SIMD void predict_medians(const std::uint32_t* codes, std::uint32_t* residuals) {
  predict_rows<predict_planes>(codes, residuals);
}

// Of any codes.
template <unsigned Predictor>
void predict_ordered(const BlockCodes& codes, BlockCodes& residuals) {
  residuals[0] = 0;
  for (unsigned i = 1; i < 512; ++i) {
    const std::int64_t predicted = predict(Predictor, true, codes.data(), i >> 6U, i >> 3U & 7U, i & 7U);
    residuals[i] = codes[i] - static_cast<std::uint32_t>(predicted);
  }
}

// What residuals take about: the bits of three times each magnitude.
WEIR_SIMD std::uint32_t rough_bits(const std::uint32_t* residuals) {
  const Ints8 none{};
  Ints8 sum{};
  for (unsigned i = 0; i < 512; i += 8) {
    Words8 r;
    __builtin_memcpy(&r, residuals + i, sizeof r);
    const Words8 size = r >> 31 != 0 ? 0U - r : r;
    const Words8 m = 3U * size;
    Words8 half = m >> 1;
    half &= ~(half >> 1);  // so that it is not rounded up to the next power of two
    const auto f = __builtin_convertvector(reinterpret_cast<Ints8&>(half), Floats8);
    Ints8 exponent;
    __builtin_memcpy(&exponent, &f, sizeof exponent);
    exponent = (exponent >> 23) - 126;
    sum += half == 0 ? none : exponent;
    sum -= m != 0;
  }
  std::uint32_t bits = 0;
  for (int l = 0; l < 8; ++l) bits += static_cast<std::uint32_t>(sum[l]);
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
      return ordered ? predict_ordered<1>(codes, residuals) : predict_means(codes.data(), residuals.data());
    case 2:
      return ordered ? predict_ordered<2>(codes, residuals) : predict_leasts(codes.data(), residuals.data());
    default:
      return ordered ? predict_ordered<3>(codes, residuals) : predict_medians(codes.data(), residuals.data());
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
