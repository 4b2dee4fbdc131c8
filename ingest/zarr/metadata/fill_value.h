// What voxels of chunks read that a Zarr array does not store.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "format/base/scalar_type.h"
#include "ingest/source/stored_value.h"

namespace weir {

/// The value that `fill`, the fill_value of an array's metadata, stands for, as bytes of `type` in the order asked for:
/// a number, "NaN", "Infinity", "-Infinity", "0x" and the bits in hexadecimal, or, as version 2 has it for types
/// without numbers, its bytes in base64 as they are stored. Throws Error(input), beginning with `where`, where it is
/// none of these or `type` does not hold it.
std::vector<std::byte> fill_bytes(const nlohmann::json& fill, ScalarType type, bool big_endian,
                                  const std::string& where);

/// The number that `fill`, the fill_value of an array's metadata, is; NaN and infinities, too, which JSON has as texts.
/// nullopt where it is none, as null is none.
std::optional<StoredValue> number_in_fill(const nlohmann::json& fill);

/// The number that `value`, an attribute, has in base64, as the eight bytes of a double, the lowest first: as xarray
/// writes _FillValue of floats in version 3 (FillValueCoder in xarray/backends/zarr.py). nullopt where it has none.
std::optional<double> double_in_base64(const nlohmann::json& value);

/// `fill`, with 1 for true and 0 for false where the array, whose metadata are at `where`, is one of bool. Throws
/// Error(input) where it is no value of bool then.
nlohmann::json number_of_fill(const nlohmann::json& fill, bool of_bool, const std::string& where);

}  // namespace weir
