// A service in the middle of its work, for looking at: a series of 24 results with thumbnails, a queue, two running
// jobs, some that went wrong.
#pragma once

#include <filesystem>

#include "tests/daemon/support/fake_control.h"

namespace weir {

/// Fills `control`; thumbnails are written into `directory`.
void show_sample_jobs(FakeControl& control, const std::filesystem::path& directory);

/// That, and: fifteen problems alike, files that are not taken yet for several reasons, names of 180 letters, results
/// of a second watch, a disk without room.
void show_busy_sample(FakeControl& control, const std::filesystem::path& directory);

}  // namespace weir
