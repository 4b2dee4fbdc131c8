// The length of vectors: squares of their numbers are summed in double, one component after the other.
#pragma once

#include <span>

#include "ingest/source/volume_source.h"

namespace weir {

/// What `number` adds to the square of a length. One beyond 1e150 counts as that, whose square double still holds: the
/// length is beyond float32 in any case.
double squared_part(double number);

/// Roots of `sums`, rounded to float32, into `values`: missing_value() where `missing` says so, one quiet NaN where a
/// sum is NaN. The loss is that of rounding. `sums` is changed; all three have as many elements.
ConversionLoss take_lengths(std::span<double> sums, std::span<const bool> missing, std::span<float> values);

}  // namespace weir
