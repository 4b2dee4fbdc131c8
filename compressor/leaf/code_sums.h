// Assigns values to equidistant levels: finds the codes, and the sums that a least-squares fit of the levels needs. The
// results have the same bits on every machine: 16 lanes, no fused operations.
#pragma once

#include <cstddef>
#include <cstdint>

#include "compressor/leaf/code_levels.h"

namespace weir {

/// The sums of one assignment of values to levels. Deviations are from the leaf's mean, times a power of two that
/// brings them near 1, so that the squares of 1e-16 and of 1e+30 stay in the range of float.
struct CodeSums {
  double squares = 0;  ///< sum of the squared errors of the scaled deviations
  double codes = 0;    ///< sum of the codes; exact for up to 8 bits, because a lane stays below 2^24
  double code_squares = 0;
  double code_values = 0;  ///< sum of code * deviation
};

/// Fills `deviations` and returns the sum of their squares. Their number is `count` rounded up to a multiple of 16; the
/// deviations behind the last value are 0.
double deviate(const float* values, std::size_t count, float mean, float scale, float* deviations);

/// Returns all sums except CodeSums::squares.
CodeSums assign(const float* values, const float* deviations, std::size_t count, const CodeLevels& levels);
/// The same as assign() for levels of one bit, if all deviations are finite.
CodeSums assign_bit(const float* values, const float* deviations, std::size_t count, const CodeLevels& levels);

/// Returns CodeSums::squares, measured value by value. At 8 bits and more they cannot be derived from the other sums,
/// because they are too small beside the squares of the deviations.
double measure_squares(const float* values, std::size_t count, const CodeLevels& levels, float scale);

void nearest_codes(const float* values, std::size_t count, const CodeLevels& levels, std::uint16_t* codes);

}  // namespace weir
