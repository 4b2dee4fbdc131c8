#include "format/packed/residuals.h"

#include <bit>

#include "format/base/simd.h"
#include "format/packed/block_scan.h"
#include "format/packed/lattice_codes.h"

namespace weir {
namespace {

// The 3-D Lorenzo predictor's: what is left of the codes after differences along each axis in turn.
WEIR_SIMD void difference_all(const std::uint32_t* codes, std::uint32_t* residuals) {
  std::uint32_t along_x[512];
  for (unsigned i = 0; i < 64; ++i) along_x[i] = codes[i];
  for (unsigned i = 64; i < 512; ++i) along_x[i] = codes[i] - codes[i - 64];
  std::uint32_t along_y[512];
  for (unsigned x = 0; x < 512; x += 64) {
    for (unsigned i = x; i < x + 8; ++i) along_y[i] = along_x[i];
    for (unsigned i = x + 8; i < x + 64; ++i) along_y[i] = along_x[i] - along_x[i - 8];
  }
  residuals[0] = 0;
  for (unsigned i = 1; i < 512; ++i) residuals[i] = along_y[i] - (i % 8 == 0 ? 0 : along_y[i - 1]);
}

template <unsigned Predictor>
void predict_all(const BlockCodes& codes, bool ordered, BlockCodes& residuals) {
  residuals[0] = 0;
  for (unsigned i = 1; i < 512; ++i) {
    const std::int64_t predicted = predict(Predictor, ordered, codes.data(), i >> 6U, i >> 3U & 7U, i & 7U);
    residuals[i] = codes[i] - static_cast<std::uint32_t>(predicted);
  }
}

std::uint32_t magnitude_of(std::uint32_t residual) { return residual >> 31U != 0 ? 0U - residual : residual; }

// What residuals take about.
std::uint32_t rough_bits(const BlockCodes& residuals) {
  std::uint32_t bits = 0;
  for (const std::uint32_t r : residuals) bits += static_cast<std::uint32_t>(std::bit_width(3 * magnitude_of(r)));
  return bits;
}

}  // namespace

void residuals_of(const BlockCodes& codes, unsigned predictor, bool ordered, BlockCodes& residuals) {
  switch (predictor) {
    case 0:
      return difference_all(codes.data(), residuals.data());
    case 1:
      return predict_all<1>(codes, ordered, residuals);
    case 2:
      return predict_all<2>(codes, ordered, residuals);
    default:
      return predict_all<3>(codes, ordered, residuals);
  }
}

unsigned best_predictor(const BlockCodes& codes, bool ordered, BlockCodes& residuals) {
  unsigned best = 0;
  std::uint32_t least = ~0U;
  BlockCodes tried;
  for (unsigned predictor = 0; predictor < kPredictors; ++predictor) {
    residuals_of(codes, predictor, ordered, tried);
    const std::uint32_t bits = rough_bits(tried);
    if (bits >= least) continue;
    least = bits;
    best = predictor;
    residuals = tried;
  }
  return best;
}

ScanValues scan_residuals(const BlockCodes& residuals) {
  ScanValues values;
  for (unsigned place = 1; place < 512; ++place) {
    const std::uint32_t residual = residuals[kBlockScan.index[place]];
    values.negative[place] = residual >> 31U != 0;
    values.magnitudes[place] = magnitude_of(residual);
  }
  return values;
}

}  // namespace weir
