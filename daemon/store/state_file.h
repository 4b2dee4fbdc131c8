// The SQLite file that jobs are kept in: its tables and their version, and what
// opening does where the file is damaged, foreign or of a newer weir.
#pragma once

#include <string>

#include "daemon/config/foreign_state.h"
#include "daemon/store/sqlite.h"

namespace weir {

/// PRAGMA user_version. A change of the tables raises it and brings older files up to date in open_state_file.
inline constexpr int kStateVersion = 5;

/// Opens `path`, made if missing, for this process alone, durable at every commit. A damaged file is moved aside
/// to PATH.corrupt-N (its journal with it) and an empty one made; `notice` then says so in one line, else it is
/// left alone. Throws Error(input) for a newer version, another program's database and any other file that is no state
/// file (refuse_foreign_state), Error(io) where the file cannot be opened or another process has it open.
Database open_state_file(const std::string& path, std::string& notice);

}  // namespace weir
