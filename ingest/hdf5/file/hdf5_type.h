// Types of HDF5 values: which types are scalars that weir converts, and a text for any type.
#pragma once

#include <hdf5.h>

#include <optional>
#include <string>

#include "format/base/scalar_type.h"

namespace weir {

struct StoredType {
  ScalarType scalar = ScalarType::float32;
  bool big_endian = false;
};

/// Returns the scalar type of two's complement integers of 8 to 64 bits and of IEEE 754 floats of 16, 32 and 64 bits,
/// all without padding; nullopt for any other type. The caller holds Hdf5Lock.
std::optional<StoredType> stored_type(hid_t type);

/// Returns the integer type that stores an enumeration, for example h5py's booleans; nullopt for any other type. The
/// caller holds Hdf5Lock.
std::optional<StoredType> enumerated_type(hid_t type);

/// Returns a text for any type: "float32", "big-endian int16", "compound of 3 members", "float of 80 bits in 16
/// bytes". The caller holds Hdf5Lock.
std::string type_text(hid_t type);

}  // namespace weir
