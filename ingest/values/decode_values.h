// Decodes stored values to the volume's values: convert_values, and then scale, offset and missing data.
#pragma once

#include <cstddef>
#include <span>

#include "format/base/scalar_type.h"
#include "ingest/source/stored_value.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Converts as convert_values does, and applies `mapping`. Missing values become missing_value() and count as no
/// loss. If the mapping keeps them as data, they are counted as unmarked instead. In volumes that may have missing
/// values, no other value gets the bits of missing_value(). Scaled values are computed by ValueMapping::scaled, and
/// their loss is counted against its result.
ConversionLoss decode_values(std::span<const std::byte> bytes, ScalarType type, bool big_endian,
                             const ValueMapping& mapping, std::span<float> values);

}  // namespace weir
