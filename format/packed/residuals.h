// The residuals of prediction inside a block, which lattice_codes.h turns back into codes.
#pragma once

#include <array>
#include <cstdint>

#include "format/packed/coefficient_decoder.h"
#include "format/packed/row_lanes.h"

namespace weir {

/// Codes of the 512 values of a block, by index (x << 6 | y << 3 | z).
using BlockCodes = std::array<std::uint32_t, 512>;

/// Computes code minus prediction, modulo 2^32, by index; 0 at index 0. `ordered`: codes are signed, otherwise below
/// 2^24.
void residuals_of(const BlockCodes& codes, unsigned predictor, bool ordered, BlockCodes& residuals);

/// Returns the predictor with about the smallest stream, and its residuals.
unsigned best_predictor(const BlockCodes& codes, bool ordered, BlockCodes& residuals);

/// The result of fill_magnitudes().
struct ResidualSizes {
  unsigned last_place = 0;  ///< last place of the scan that is not zero; 0 if all are zero
  std::uint32_t bits = 0;   ///< the bitwise or of all magnitudes
};

/// Fills `magnitudes` with the magnitudes of `residuals`, by index.
ResidualSizes fill_magnitudes(const BlockCodes& residuals, MagnitudeRows& magnitudes);

}  // namespace weir
