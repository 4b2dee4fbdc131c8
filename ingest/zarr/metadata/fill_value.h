// The fill value of a Zarr array: the value of voxels in chunks that the array does not store.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "format/base/scalar_type.h"
#include "ingest/source/stored_value.h"

namespace weir {

/// Returns the value of `fill`, the fill_value of an array's metadata, as bytes of `type` in the requested byte
/// order. `fill` may be a number, "NaN", "Infinity", "-Infinity", or "0x" with the bits in hexadecimal. It may also
/// be the stored bytes in base64, as version 2 writes it for types without numbers. Throws Error(input), beginning
/// with `where`, if `fill` is none of these or does not fit `type`.
std::vector<std::byte> fill_bytes(const nlohmann::json& fill, ScalarType type, bool big_endian,
                                  const std::string& where);

/// Returns `fill`, the fill_value of an array's metadata, as a number. NaN and infinities, which JSON stores as
/// texts, are numbers too. Returns nullopt if `fill` is not a number, for example null.
std::optional<StoredValue> number_in_fill(const nlohmann::json& fill);

/// Returns the number that the attribute `value` holds in base64: the eight bytes of a double, the lowest first.
/// xarray writes _FillValue of floats this way in version 3 (FillValueCoder in xarray/backends/zarr.py). Returns
/// nullopt if `value` is not in this form.
std::optional<double> double_in_base64(const nlohmann::json& value);

/// Returns `fill`, with true replaced by 1 and false by 0 if the array is an array of bool (`of_bool`). Throws
/// Error(input), beginning with `where`, the place of the array's metadata, if `fill` is not a value of such an
/// array.
nlohmann::json number_of_fill(const nlohmann::json& fill, bool of_bool, const std::string& where);

}  // namespace weir
