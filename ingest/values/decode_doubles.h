// Stored numbers as doubles: what places and times need, where a volume's values are float32.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "format/base/scalar_type.h"
#include "ingest/source/stored_value.h"

namespace weir {

/// All of `bytes`, whole values of `type`, after `mapping`; NaN where it says that they are missing. What a double
/// cannot hold, integers beyond 53 bits for instance, is rounded, once they are scaled.
std::vector<double> decode_doubles(std::span<const std::byte> bytes, ScalarType type, bool big_endian,
                                   const ValueMapping& mapping);

}  // namespace weir
