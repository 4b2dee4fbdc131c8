// Converts values as they lie in a file to float32.
#pragma once

#include <cstddef>
#include <span>

#include "format/base/scalar_type.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Returns whether the bytes of a file already are the float32 values on this machine.
bool is_native_float32(ScalarType type, bool big_endian);

/// Converts `values.size()` values of `type` from `bytes`, which holds exactly this many and needs no alignment, and
/// returns what was lost. 8- and 16-bit integers, float16, bfloat16 and float32 (NaN payloads included) lose nothing.
/// Wider integers above 2^24 and float64 are rounded to nearest even. A finite float64 beyond the range of float32
/// becomes infinite. Non-finite values are not counted.
ConversionLoss convert_values(std::span<const std::byte> bytes, ScalarType type, bool big_endian,
                              std::span<float> values);

}  // namespace weir
