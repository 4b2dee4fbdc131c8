// Checks the state file of the configuration before SQLite opens it.
#pragma once

#include <string>

namespace weir {

/// PRAGMA application_id of a state file, "weir".
inline constexpr int kStateApplication = 0x77656972;

/// Throws Error(input) if `path` is a file of something else. A file passes if it is empty, begins as an SQLite file,
/// has weir's application ID, has only zeros on its first page, or has a journal beside it: it may be a damaged state
/// file. An unreadable file is left to the code that opens it. Must not be called for a file that SQLite has open in
/// this process, because closing the file drops SQLite's locks.
void refuse_foreign_state(const std::string& path);

}  // namespace weir
