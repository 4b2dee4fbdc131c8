// From the page cache to the device without a copy in host memory: its own pages are locked and copied from.
#pragma once

#include "gpu/cuda/load/copy_task.h"

namespace weir {

/// Chunks go through four stages at the same time. `task.threads` threads each take the next chunk, bring its pages
/// into memory (FileMapping::populate) and page-lock it; the calling thread queues the copies in the order in which
/// chunks become ready; one thread unlocks what is copied. At most threads + 3 chunks are locked at a time: one that
/// copies, one that is unlocked, one that waits, and those in preparation.
///
/// A file that is truncated meanwhile is an Error(input) and no signal, because only the kernel touches its pages,
/// and locked pages stay. Where the system does not page-lock the mapping's pages, or starts no threads, the outcome
/// says so; some of the target may be overwritten then. On return, and on a throw, nothing is locked and nothing
/// copies. Throws Error(input, io, interrupted).
CopyOutcome registered_copy(const CopyTask& task);

}  // namespace weir
