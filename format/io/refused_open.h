// The error for a file that the system does not open for reading.
#pragma once

#include <string>

#include "format/base/error.h"

namespace weir {

/// Returns whether a call of the system failed because of the name it was given, for instance a missing file. Failures
/// of permissions, devices, servers, descriptors or memory may go away, and tell nothing about the file.
bool is_fault_of_name(int errno_value);

/// Returns "PATH: cannot ACTION: ..." with the remedy: Error(input) if the name is at fault, otherwise Error(io).
Error refused_open(const std::string& path, const char* action, int errno_value);

}  // namespace weir
