// The end of what a command writes on stdout.
#pragma once

#include "format/base/error.h"

namespace weir {

/// Of kind io: a write to stdout that failed with `errno_value`.
Error stdout_error(int errno_value);

/// Writes what stdout still buffers. Throws stdout_error where that or a write before it failed. A pipe whose reader
/// has gone (`| head`) is no error.
void finish_stdout();

}  // namespace weir
