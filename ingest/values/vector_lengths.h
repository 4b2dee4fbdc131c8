// Computes the length of vectors. Squares of their numbers are summed in double, one component after the other.
#pragma once

#include <span>

#include "ingest/source/volume_source.h"

namespace weir {

/// Returns what `number` adds to the square of a length. A number beyond 1e150 counts as 1e150, because a double
/// still holds its square. The length is beyond float32 in any case.
double squared_part(double number);

/// Writes the square roots of `sums`, rounded to float32, into `values`. A value is missing_value() if `missing` says
/// so, and one fixed quiet NaN if its sum is NaN. Returns the loss of rounding. Changes `sums`. All three spans have
/// the same length.
ConversionLoss take_lengths(std::span<double> sums, std::span<const bool> missing, std::span<float> values);

}  // namespace weir
