// A file that the system does not open for reading.
#pragma once

#include <string>

#include "format/base/error.h"

namespace weir {

/// Whether a call of the system failed at the name that it was given, as of a file that is missing. Rights, devices,
/// servers, descriptors and memory may come back, and say nothing of what the file holds.
bool is_fault_of_name(int errno_value);

/// "PATH: cannot ACTION: ...", with the remedy: Error(input) where the name is at fault, else Error(io).
Error refused_open(const std::string& path, const char* action, int errno_value);

}  // namespace weir
