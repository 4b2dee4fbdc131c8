// Bounds the queue of events that cannot be written to the state file yet: it grows with the number of files, not
// with the number of writes.
#pragma once

#include <cstddef>
#include <deque>

#include "daemon/watch/file_event.h"

namespace weir {

/// Keeps only the last of equal events: only what happened to a file, and what happened last, matters. Returns how
/// many of the first `first` events remain; they stay at the front.
std::size_t drop_repeated_events(std::deque<FileEvent>& events, std::size_t first);

}  // namespace weir
