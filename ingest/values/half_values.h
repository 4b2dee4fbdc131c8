// Encodes numbers as float16 and bfloat16.
#pragma once

#include <cstdint>

#include "format/base/scalar_type.h"
#include "ingest/source/stored_value.h"

namespace weir {

/// Returns the bits of the IEEE half nearest to `value`, ties to even. `value` is NaN, infinite or finite below 65520
/// in size.
std::uint16_t half_bits(double value);
/// Returns the bits of the bfloat16 nearest to `value`, ties to even. `value` is NaN, infinite or a finite value that
/// float32 holds.
std::uint16_t bfloat16_bits(double value);

/// Returns `mapping` with the missing values as `type`, float16 or bfloat16, stores them: -999.9 becomes the -1000
/// that a float16 holds. Missing values that `type` cannot hold are left out.
ValueMapping with_stored_missing(const ValueMapping& mapping, ScalarType type);

}  // namespace weir
