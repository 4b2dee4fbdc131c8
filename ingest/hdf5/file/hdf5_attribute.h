// Reads attributes as numbers or texts, whatever type the file stores them in.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "ingest/source/stored_value.h"

namespace weir {

/// An attribute with more values, or more bytes of text, than these limits reads as empty, so it gives no position and
/// no name.
inline constexpr std::size_t kMaxAttributeValues = 4096;
inline constexpr std::size_t kMaxAttributeBytes = std::size_t{1} << 20U;

/// The limit for all attributes of one object together, if the file keeps them in a separate (dense) heap.
inline constexpr std::size_t kMaxObjectAttributeBytes = std::size_t{16} << 20U;

/// Throws Error(input) if the attributes of `object` exceed kMaxObjectAttributeBytes. The check is needed because the
/// library takes twice the bytes of an attribute to look whether it is there. For a chunked dataset the check looks
/// through the chunk index, so call it only once per object. The caller holds Hdf5Lock.
void check_attribute_bytes(hid_t object);

/// All functions below take an open dataset or group, and the caller holds Hdf5Lock. An attribute that is absent or
/// of another kind reads as empty. All functions throw Error(input) if the library cannot say whether the attribute
/// is there, or cannot read it: to treat it as absent would silently give other values or positions.

/// Returns integers and floats of any precision as double.
std::vector<double> number_attribute(hid_t object, const char* name);
/// Returns numbers like number_attribute(), but without loss for 64-bit integers. A text that is a number counts as a
/// number.
std::vector<StoredValue> stored_value_attribute(hid_t object, const char* name);
/// Returns values like stored_value_attribute(). Names of an enumeration count as the integers that they stand for.
std::vector<StoredValue> enumerated_value_attribute(hid_t object, const char* name);
/// Returns texts of fixed or variable length, without the blanks and zeros at their ends.
std::vector<std::string> text_attribute(hid_t object, const char* name);
/// Returns the first text of text_attribute(); empty if there is none.
std::string first_text_attribute(hid_t object, const char* name);
bool has_attribute(hid_t object, const char* name);
/// Returns the number of values of the attribute, even if there are too many to read; 0 if the attribute is absent.
std::size_t attribute_values(hid_t object, const char* name);
/// Returns the words for the attribute's value in a message: "0", "'half'", "2 values (1, 2)", "of type boolean",
/// "empty".
std::string attribute_found(hid_t object, const char* name);

/// Returns an Error(input) for the library call that failed last: "PATH: /fields/density: its attributes cannot be
/// read, looking for NAME: REASON; ...". The library decodes an object's attributes in turn until it finds `name`, so
/// the damage may be in another attribute.
Error attribute_error(hid_t object, const char* name);

}  // namespace weir
