// The sums for fitting a quantiser to 512 values in equal pairs of rows; each plane occurs `planes` times
// (LeafRepeats). They are the same, addition by addition, as sums over all values.
#pragma once

#include <cstddef>

#include "compressor/leaf/code_sums.h"

namespace weir {

/// Fills the deviations of the first row of each pair in the first plane of each group. Returns the sum of the squares
/// of all 512 deviations.
double twin_deviate(const float* values, std::size_t planes, float mean, float scale, float* deviations);

/// Returns all sums except CodeSums::squares. `deviations` are those that twin_deviate() fills.
CodeSums twin_assign(const float* values, const float* deviations, std::size_t planes, const CodeLevels& levels);

/// Returns the sum of the squares of the scaled errors.
double twin_measure(const float* values, std::size_t planes, const CodeLevels& levels, float scale);

}  // namespace weir
