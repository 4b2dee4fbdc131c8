// Copies from the page cache to the device without a copy in host memory: locks the cache's own pages and copies from
// them.
#pragma once

#include "gpu/cuda/load/copy_task.h"

namespace weir {

/// Chunks go through four stages at the same time. `task.threads` threads each take the next chunk, bring its pages
/// into memory (FileMapping::populate) and page-lock it; the calling thread queues the copies in the order in which
/// chunks become ready; one thread unlocks what is copied. At most threads + 3 chunks are locked at a time: one that
/// copies, one that is unlocked, one that waits, and those in preparation.
///
/// A file that is truncated during the copy causes an Error(input) and no signal: only the kernel touches its pages,
/// and locked pages stay. If the system does not page-lock the mapping's pages, or starts no threads, the outcome
/// says so; part of the target may be overwritten then. On return, and after a throw, nothing is locked and nothing
/// copies. Throws Error(input, io, interrupted).
CopyOutcome registered_copy(const CopyTask& task);

}  // namespace weir
