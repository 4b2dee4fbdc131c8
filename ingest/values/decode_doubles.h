// Decodes stored numbers as doubles. Places and times need doubles; a volume's values are float32.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "format/base/scalar_type.h"
#include "ingest/source/stored_value.h"

namespace weir {

/// Returns all values of `bytes`, whole values of `type`, after `mapping`; missing values become NaN. Numbers that a
/// double cannot hold, for instance integers beyond 53 bits, are rounded after they are scaled.
std::vector<double> decode_doubles(std::span<const std::byte> bytes, ScalarType type, bool big_endian,
                                   const ValueMapping& mapping);

}  // namespace weir
