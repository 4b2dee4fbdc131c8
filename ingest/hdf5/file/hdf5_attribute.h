// Attributes as numbers or texts, whatever type the file gives them.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "ingest/source/stored_value.h"

namespace weir {

/// An attribute of more values, or of more bytes of text, than this gives no place and no name, and is read as none.
inline constexpr std::size_t kMaxAttributeValues = 4096;
inline constexpr std::size_t kMaxAttributeBytes = std::size_t{1} << 20U;

/// Of all attributes of one object together, where the file keeps them in a heap of their own.
inline constexpr std::size_t kMaxObjectAttributeBytes = std::size_t{16} << 20U;

/// Throws Error(input) where `object` has more than that: the library takes twice the bytes of an attribute to look
/// whether it is there. Of chunks it costs a look through their index: once for an object is enough. The caller holds
/// Hdf5Lock.
void check_attribute_bytes(hid_t object);

/// All of them take an open dataset or group; the caller holds Hdf5Lock. An attribute that is absent or of another kind
/// reads as empty. All throw Error(input) where the library cannot say whether the attribute is there, or cannot read
/// it: taken as absent, it would give other values or places without a word.

/// Integers and floats of any precision, in double.
std::vector<double> number_attribute(hid_t object, const char* name);
/// The same without loss for 64-bit integers; a text that is a number counts as one.
std::vector<StoredValue> stored_value_attribute(hid_t object, const char* name);
/// The same; names of an enumeration count as the integers that they stand for.
std::vector<StoredValue> enumerated_value_attribute(hid_t object, const char* name);
/// Texts of fixed or any length, without the blanks and zeros at their ends.
std::vector<std::string> text_attribute(hid_t object, const char* name);
/// The first of them; empty where there is none.
std::string first_text_attribute(hid_t object, const char* name);
bool has_attribute(hid_t object, const char* name);
/// How many values it has, also where they are more than are read; 0 where it is absent.
std::size_t attribute_values(hid_t object, const char* name);
/// What a message says that the attribute is: "0", "'half'", "2 values (1, 2)", "of type boolean", "empty".
std::string attribute_found(hid_t object, const char* name);

/// "PATH: /fields/density: its attributes cannot be read, looking for NAME: REASON; ...", kind input, of the call of
/// the library that failed last. The library decodes an object's attributes until it finds the one that it is asked
/// for: the damage may be to another of them.
Error attribute_error(hid_t object, const char* name);

}  // namespace weir
