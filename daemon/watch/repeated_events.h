// Events that wait, while they cannot be written down: as many as there are files, not as there are writes.
#pragma once

#include <cstddef>
#include <deque>

#include "daemon/watch/file_event.h"

namespace weir {

/// Of equal ones keeps the last: what counts is what happened to a file, and what happened to it last. Returns how many
/// of the first `first` are left, which stand first again.
std::size_t drop_repeated_events(std::deque<FileEvent>& events, std::size_t first);

}  // namespace weir
