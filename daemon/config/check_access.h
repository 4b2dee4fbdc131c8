// Checks whether the user that runs the process may use the paths of a configuration.
#pragma once

#include "daemon/config/config.h"

namespace weir {

/// Throws Error(io) for the first path that the service must write to or read and may not. The message is one line: the
/// path, its key, the user, the reason and a remedy. Also throws Error(io) if every conversion would fail: work_dir is
/// missing or on a memory file system, or an output is on /proc or a similar file system. Checks state, log, port_file,
/// control_socket and work_dir. Checks of each watch its output (missing directories count as fine if they can be made;
/// an output on an unmounted output_mount is skipped) and its directory if it exists. Throws Error(input) if `state` is
/// a file of something else, but does not check this if `state_is_open`: this process has the state file open and has
/// checked it before. Changes nothing. Does not notice a full disk.
void check_access(const DaemonConfig& config, bool state_is_open = false);

}  // namespace weir
