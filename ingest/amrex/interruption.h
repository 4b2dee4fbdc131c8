// Ends the opening of a large plotfile early.
#pragma once

#include <atomic>

#include "format/base/error.h"

namespace weir {

/// Set by another thread or a signal handler; may be null.
using Interruption = const std::atomic<bool>*;

/// Throws Error(interrupted) where it is set.
inline void throw_if_interrupted(Interruption interruption) {
  if (interruption != nullptr && *interruption) throw Error(ErrorKind::interrupted, "interrupted");
}

}  // namespace weir
