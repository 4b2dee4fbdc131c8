// Checks the state file of the configuration before SQLite opens it.
#pragma once

#include <cstdint>
#include <string>

#include "format/base/error.h"

namespace weir {

/// PRAGMA application_id of a state file, "weir".
inline constexpr int kStateApplication = 0x77656972;
/// PRAGMA user_version of a state file. A change of the tables raises this number, and open_state_file() updates older
/// files.
inline constexpr int kStateVersion = 5;

/// Returns Error(input) for a state file of a newer weir.
Error newer_state(const std::string& path, std::int64_t version);

/// Throws Error(input) if `path` is a file of something else or of a newer weir, is no regular file, or is a link into
/// a directory that does not exist. A file passes if it is empty, begins as an SQLite file, has weir's application ID,
/// has only zeros on its first page, or has a journal beside it: it may be a damaged state file. An unreadable file is
/// left to the code that opens it. Must not be called for a file that SQLite has open in this process, because closing
/// the file drops SQLite's locks.
void refuse_foreign_state(const std::string& path);

}  // namespace weir
