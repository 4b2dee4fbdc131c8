// Stored values to the volume's: convert_values, and then scale, offset and
// missing data.
#pragma once

#include <cstddef>
#include <span>

#include "format/base/scalar_type.h"
#include "ingest/source/stored_value.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// As convert_values, after `mapping`: missing values, and they alone where there may be any, become missing_value()
/// and count as no loss, unless the mapping keeps them as data, which counts them as unmarked; scaled ones are computed
/// by ValueMapping::scaled, and their loss is counted against what that gives.
ConversionLoss decode_values(std::span<const std::byte> bytes, ScalarType type, bool big_endian,
                             const ValueMapping& mapping, std::span<float> values);

}  // namespace weir
