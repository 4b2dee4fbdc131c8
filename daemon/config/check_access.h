// Whether the user that runs this may use the paths of a configuration.
#pragma once

#include "daemon/config/config.h"

namespace weir {

/// Throws Error(io) for the first path that the service must write to or read and may not: one line with the path, its
/// key, the user, the reason and a remedy; and for a work_dir that is missing or memory, or an output on /proc or its
/// like, with which every conversion would fail. Looked at are the state file, log, port_file, control_socket and
/// work_dir, and of each watch its output (what is missing of it can be made) and its directory, where that is there
/// already. Throws Error(input) where `state` is a file of something else; `state_is_open`, in this process: that was
/// looked at before. Changes nothing; a full disk is not noticed.
void check_access(const DaemonConfig& config, bool state_is_open = false);

}  // namespace weir
