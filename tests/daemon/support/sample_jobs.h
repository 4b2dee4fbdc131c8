// Sample content of a busy service, to look at: a series of 24 results with thumbnails, a queue, two running jobs,
// and some failed jobs.
#pragma once

#include <filesystem>

#include "tests/daemon/support/fake_control.h"

namespace weir {

/// Fills `control`; thumbnails are written into `directory`.
void show_sample_jobs(FakeControl& control, const std::filesystem::path& directory);

/// Fills `control` like show_sample_jobs(). Adds fifteen problems with the same reason, files that are not taken yet
/// for several reasons, names of 180 letters, results of a second watch, and a full disk.
void show_busy_sample(FakeControl& control, const std::filesystem::path& directory);

}  // namespace weir
