// What libhdf5 says went wrong, as an Error.
#pragma once

#include <hdf5.h>

#include <string>

#include "format/base/error.h"

namespace weir {

/// What the innermost function that failed in the last call of the library says; the caller has held
/// Hdf5Lock since. "no reason given" where it says nothing. One line of printable characters.
std::string hdf5_reason();

/// "PATH: /fields/density" of an open object; PATH is the file that it lies in. The caller holds Hdf5Lock.
std::string object_text(hid_t object);

/// "WHERE: WHAT: REASON", kind input, of the last call as above.
Error hdf5_error(const std::string& where, const std::string& what);

}  // namespace weir
