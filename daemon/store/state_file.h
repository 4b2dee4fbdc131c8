// The SQLite file of the jobs: its tables and their version, and how a damaged, foreign or newer file is opened.
#pragma once

#include <string>

#include "daemon/config/foreign_state.h"
#include "daemon/store/sqlite.h"

namespace weir {

/// Opens `path` for this process alone, durable at every commit; creates the file if it is missing. A damaged file is
/// moved aside to PATH.corrupt-N (with its journal), and an empty one is created; `notice` then says so in one line,
/// otherwise it is unchanged. Throws Error(input) for a newer version, another program's database or any other file
/// that is no state file (refuse_foreign_state), Error(io) if the file cannot be opened or another process has it
/// open.
Database open_state_file(const std::string& path, std::string& notice);

}  // namespace weir
