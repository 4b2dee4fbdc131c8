#include "format/packed/residuals.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace weir::residuals_test
