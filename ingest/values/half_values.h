// Numbers as float16 and bfloat16 store them.
#pragma once

#include <cstdint>

#include "format/base/scalar_type.h"
#include "ingest/source/stored_value.h"

namespace weir {

/// The bits of the IEEE half nearest to `value`, ties to even: of a finite one below 65520, of NaN and infinities.
std::uint16_t half_bits(double value);
/// The bits of the bfloat16 nearest to `value`, ties to even: of a finite one that float32 holds, of NaN and
/// infinities.
std::uint16_t bfloat16_bits(double value);

/// `mapping` with the missing values that `type`, float16 or bfloat16, stores: -999.9 as the -1000 that a float16 makes
/// of it. Those that it cannot hold are left out.
ValueMapping with_stored_missing(const ValueMapping& mapping, ScalarType type);

}  // namespace weir
