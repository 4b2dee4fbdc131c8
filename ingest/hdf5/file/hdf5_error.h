// What libhdf5 says went wrong, as an Error.
#pragma once

#include <hdf5.h>

#include <string>

#include "format/base/error.h"

namespace weir {

/// Returns the message of the innermost function that failed in the library's last call, or "no reason given" if the
/// library has none. The text is one line of printable characters. The caller has held Hdf5Lock since that call.
std::string hdf5_reason();

/// Returns "PATH: /fields/density" for an open object; PATH is the file that holds the object. The caller holds
/// Hdf5Lock.
std::string object_text(hid_t object);

/// Returns Error(input) "WHERE: WHAT: REASON", with REASON from hdf5_reason().
Error hdf5_error(const std::string& where, const std::string& what);

}  // namespace weir
