// The state of a file at one moment. It later tells whether the file has been written to, cut, or replaced.
#pragma once

#include <sys/stat.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "format/base/error.h"

namespace weir {

struct FileState {
  std::string path;
  bool exists = false;  ///< if false, all members below are 0
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  std::uint64_t bytes = 0;
  std::int64_t mtime_ns = 0;  ///< since 1970, of the content
  std::int64_t ctime_ns = 0;  ///< since 1970, of content, name and rights: no program can set it back

  bool operator==(const FileState&) const = default;
};

/// Returns the state from the `status` that fstat or stat found for `path`.
FileState state_of(const std::string& path, const struct stat& status);

/// Returns the current state of the file that `path` leads to.
FileState look_at_file(const std::string& path);

/// Part of every message about a source that changed, and of no other message. It tells the service that another
/// attempt may succeed.
inline constexpr std::string_view kChangedWhileRead = "changed while it was read";

inline constexpr std::string_view kConvertAgain = "; convert it again once nothing writes to it";  ///< message's end

/// Returns Error(input), "PATH: changed while it was read: WHAT; convert it again once nothing writes to it".
Error changed_error(const std::string& path, const std::string& what);

/// Returns the first of `files` that does not lie in or below `directory`, which exists, after symbolic links are
/// resolved: the path that its name leads to. A file that is no longer the file that was opened by this name counts,
/// too. Returns nullopt if every file lies there and is the file that was opened.
std::optional<std::string> file_outside(std::span<const FileState> files, const std::string& directory);

/// Returns by how many nanoseconds a time may be off, because of the file system's resolution. File systems that
/// count whole seconds may be off by up to two seconds.
std::int64_t tick_of(std::int64_t time_ns);

/// Returns whether the status change time of `file` is not older than the content of `record`, which was written
/// after `file`. If so, the file was replaced (cp -p, rsync -t), or rewritten and its time set back. On a file system
/// that counts whole seconds (FAT counts two), the result may be true although nothing changed.
bool touched_since(const FileState& file, const FileState& record);

/// Looks at the files again. Throws changed_error for the first file that is not in the state that `files` gives.
void check_unchanged(std::span<const FileState> files);

}  // namespace weir
