// The sums of fitting a quantiser to 512 values in equal pairs of rows, each plane of them `planes` times
// (LeafRepeats): the same, addition by addition, as over all values.
#pragma once

#include <cstddef>

#include "compressor/leaf/code_sums.h"

namespace weir {

/// Fills the deviations of the first rows of the first planes, and returns the sum of all their squares.
double twin_deviate(const float* values, std::size_t planes, float mean, float scale, float* deviations);

/// All but the squares of the errors. `deviations` as twin_deviate leaves them.
CodeSums twin_assign(const float* values, const float* deviations, std::size_t planes, const CodeLevels& levels);

/// The squares of the scaled errors.
double twin_measure(const float* values, std::size_t planes, const CodeLevels& levels, float scale);

}  // namespace weir
