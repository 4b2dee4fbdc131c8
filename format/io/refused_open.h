// A file that the system does not open for reading.
#pragma once

#include <string>

#include "format/base/error.h"

namespace weir {

/// "PATH: cannot ACTION: ...", with the remedy. What is wrong with the name is wrong with the input; rights, devices,
/// servers, descriptors and memory may come back, and say nothing of what the file holds: those are Error(io).
Error refused_open(const std::string& path, const char* action, int errno_value);

}  // namespace weir
