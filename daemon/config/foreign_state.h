// The file that the configuration names as state, before SQLite opens it.
#pragma once

#include <string>

namespace weir {

/// PRAGMA application_id of a state file, "weir".
inline constexpr int kStateApplication = 0x77656972;

/// Throws Error(input) where `path` is a file of something else: it has bytes, and neither SQLite's beginning, nor
/// weir's application ID, nor zeros alone on its first page, nor a journal beside it. What has one of these may be a
/// damaged state file. What cannot be read is left to who opens it. Not for a file that SQLite has open in this
/// process: closing it drops that one's locks.
void refuse_foreign_state(const std::string& path);

}  // namespace weir
