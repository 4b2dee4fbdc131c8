// Lets a user interrupt the opening of a large plotfile.
#pragma once

#include <atomic>

#include "format/base/error.h"

namespace weir {

/// A flag that another thread or a signal handler sets; may be null.
using Interruption = const std::atomic<bool>*;

/// Throws Error(interrupted) if the flag is set.
inline void throw_if_interrupted(Interruption interruption) {
  if (interruption != nullptr && *interruption) throw Error(ErrorKind::interrupted, "interrupted");
}

}  // namespace weir
