// Finishes the output on stdout.
#pragma once

#include "format/base/error.h"

namespace weir {

/// Returns an Error(io) for a write to stdout that failed with `errno_value`.
Error stdout_error(int errno_value);

/// Flushes stdout. Throws stdout_error if this or an earlier write failed. A pipe whose reader has gone (`| head`) is
/// no error.
void finish_stdout();

}  // namespace weir
