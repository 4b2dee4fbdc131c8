// Values assigned to equidistant levels: the codes, and the sums that a least-squares fit of the levels takes. The same
// bits on every machine: 16 lanes, nothing fused.
#pragma once

#include <cstddef>
#include <cstdint>

#include "compressor/leaf/code_levels.h"

namespace weir {

/// What one assignment of values to levels comes to. Deviations are from the leaf's mean, times a power of two that
/// brings them near 1, so that neither 1e-16 nor 1e+30 squared leaves the range of float.
struct CodeSums {
  double squares = 0;  ///< of the errors of the scaled deviations
  double codes = 0;    ///< exact: below 2^24 a lane for up to 8 bits
  double code_squares = 0;
  double code_values = 0;  ///< code * deviation
};

/// Fills the deviations, as many as there are values rounded up to 16, 0 behind the last one, and returns the sum of
/// their squares.
double deviate(const float* values, std::size_t count, float mean, float scale, float* deviations);

/// All but the squares.
CodeSums assign(const float* values, const float* deviations, std::size_t count, const CodeLevels& levels);
/// The same of levels of one bit, where all deviations are finite.
CodeSums assign_bit(const float* values, const float* deviations, std::size_t count, const CodeLevels& levels);

/// The squares, which at 8 bits and more are too small beside those of the deviations to follow from the other sums.
double measure_squares(const float* values, std::size_t count, const CodeLevels& levels, float scale);

void nearest_codes(const float* values, std::size_t count, const CodeLevels& levels, std::uint16_t* codes);

}  // namespace weir
