#include "format/packed/residuals.h"

#include <gtest/gtest.h>

#include <bit>

#include "format/packed/lattice_codes.h"
#include "tests/format/packed/block_samples.h"

namespace weir::residuals_test {
namespace {

// Codes of that many bits, some of them runs of one value.
BlockCodes codes_of(packed_test::Numbers& numbers, unsigned bits) {
  BlockCodes codes;
  std::uint32_t last = 0;
  for (std::uint32_t& code : codes) {
    const std::uint32_t drawn = bits == 32 ? numbers.bits() : numbers.bits() & ((1U << bits) - 1U);
    last = numbers.below(4) == 0 ? last : drawn;
    code = last;
  }
  return codes;
}

TEST(Residuals, AreWhatThePredictorsLeave) {
  packed_test::Numbers numbers(11);
  for (const bool ordered : {false, true}) {
    for (unsigned trial = 0; trial < 400; ++trial) {
      const BlockCodes codes = codes_of(numbers, ordered ? 32 : 1 + trial % 24);
      for (unsigned predictor = 0; predictor < kPredictors; ++predictor) {
        BlockCodes residuals;
        residuals_of(codes, predictor, ordered, residuals);
        ASSERT_EQ(residuals[0], 0U);
        for (unsigned i = 1; i < 512; ++i) {
          const auto predicted = predict(predictor, ordered, codes.data(), i >> 6U, i >> 3U & 7U, i & 7U);
          ASSERT_EQ(residuals[i], codes[i] - static_cast<std::uint32_t>(predicted)) << predictor << ' ' << i;
        }
        residuals[0] = codes[0];
        undo_prediction(predictor, ordered, residuals.data());
        ASSERT_EQ(residuals, codes) << predictor;
      }
    }
  }
}

// Bits of three times the magnitudes, one by one.
std::uint32_t rough_bits(const BlockCodes& residuals) {
  std::uint32_t bits = 0;
  for (const std::uint32_t r : residuals) {
    const std::uint32_t magnitude = r >> 31U != 0 ? 0U - r : r;
    bits += static_cast<std::uint32_t>(std::bit_width(3U * magnitude));
  }
  return bits;
}

TEST(Residuals, BestPredictorIsTheFirstOfThoseWithTheFewestBits) {
  packed_test::Numbers numbers(12);
  for (const bool ordered : {false, true}) {
    for (unsigned trial = 0; trial < 400; ++trial) {
      const BlockCodes codes = codes_of(numbers, ordered ? 1 + trial % 32 : 1 + trial % 24);
      unsigned expected = 0;
      std::uint32_t least = ~0U;
      BlockCodes of_expected{};
      for (unsigned predictor = 0; predictor < kPredictors; ++predictor) {
        BlockCodes residuals;
        residuals_of(codes, predictor, ordered, residuals);
        if (rough_bits(residuals) >= least) continue;
        least = rough_bits(residuals);
        expected = predictor;
        of_expected = residuals;
      }
      BlockCodes residuals;
      ASSERT_EQ(best_predictor(codes, ordered, residuals), expected) << trial;
      ASSERT_EQ(residuals, of_expected) << trial;
    }
  }
}

}  // namespace
}  // namespace weir::residuals_test
