// Attributes as numbers or texts, whatever type the file gives them.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <string>
#include <vector>

#include "ingest/source/stored_value.h"

namespace weir {

/// An attribute of more values, or of more bytes of text, than this is read as none.
inline constexpr std::size_t kMaxAttributeValues = 4096;
inline constexpr std::size_t kMaxAttributeBytes = std::size_t{1} << 20U;

/// All of them take an open dataset or group; the caller holds Hdf5Lock. An attribute that is absent, cannot
/// be read or is of another kind reads as empty; none throws.

/// Integers and floats of any precision, in double.
std::vector<double> number_attribute(hid_t object, const char* name);
/// The same without loss for 64-bit integers; a text that is a number counts as one.
std::vector<StoredValue> stored_value_attribute(hid_t object, const char* name);
/// Texts of fixed or any length, without the blanks and zeros at their ends.
std::vector<std::string> text_attribute(hid_t object, const char* name);
bool has_attribute(hid_t object, const char* name);

}  // namespace weir
