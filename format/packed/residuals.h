// What prediction inside a block leaves of its codes: what lattice_codes.h undoes.
#pragma once

#include <array>
#include <cstdint>

#include "format/packed/coefficient_decoder.h"
#include "format/packed/row_lanes.h"

namespace weir {

/// Codes of the 512 values of a block, by index (x << 6 | y << 3 | z).
using BlockCodes = std::array<std::uint32_t, 512>;

/// Code minus prediction, modulo 2^32, by index; that of index 0 is 0. `ordered`: codes are signed, else below 2^24.
void residuals_of(const BlockCodes& codes, unsigned predictor, bool ordered, BlockCodes& residuals);

/// The predictor whose residuals take about the least, and these.
unsigned best_predictor(const BlockCodes& codes, bool ordered, BlockCodes& residuals);

/// What fill_magnitudes() has found.
struct ResidualSizes {
  unsigned last_place = 0;  ///< of the scan that is not zero; 0 where all are
  std::uint32_t bits = 0;   ///< all that are set in any magnitude
};

/// Magnitudes of residuals, by index.
ResidualSizes fill_magnitudes(const BlockCodes& residuals, MagnitudeRows& magnitudes);

}  // namespace weir
