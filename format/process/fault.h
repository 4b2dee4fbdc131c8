// The error for an exception that is not an Error: what the standard library or oneTBB throws.
#pragma once

#include <exception>

#include "format/base/error.h"

namespace weir {

/// The message of an error when a thread cannot be started.
inline constexpr const char* kNoMoreThreads =
    "no more threads can be started; raise the limit of processes (ulimit -u) or of address space (ulimit -v), or end "
    "some";

/// Returns whether `error` tells that the system let no more threads start.
bool says_no_thread(const std::exception& error);

/// Returns the error for `error`. A lack of memory or threads is blamed on the machine, everything else on weir.
/// `smaller`: what to reduce when memory is short.
Error fault_of(const std::exception& error, const Message& smaller = option("memory"));

/// Returns the exception that is being handled; one that is not an Error becomes its fault_of().
Error error_in_flight();

}  // namespace weir
