// A file as it is at one moment: enough to know later whether it has been
// written to, cut, or replaced by another one meanwhile.
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
  bool exists = false;  ///< all below is 0 where it does not
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  std::uint64_t bytes = 0;
  std::int64_t mtime_ns = 0;  ///< since 1970, of the content
  std::int64_t ctime_ns = 0;  ///< since 1970, of content, name and rights: no program can set it back

  bool operator==(const FileState&) const = default;
};

/// Of what fstat or stat found behind `path`.
FileState state_of(const std::string& path, const struct stat& status);

/// Of what `path` leads to now.
FileState look_at_file(const std::string& path);

/// Part of every message about a source that changed, and of no other: it tells the service that another attempt may
/// succeed.
inline constexpr std::string_view kChangedWhileRead = "changed while it was read";

inline constexpr std::string_view kConvertAgain = "; convert it again once nothing writes to it";  ///< its end

/// Error(input), "PATH: changed while it was read: WHAT; convert it again once nothing writes to it".
Error changed_error(const std::string& path, const std::string& what);

/// The first of `files` that does not lie in `directory`, which exists, or below, symbolic links resolved, or is no
/// longer the file that was opened by that name; as the path that its name leads to. nullopt: all of them do.
std::optional<std::string> file_outside(std::span<const FileState> files, const std::string& directory);

/// Nanoseconds by which a time may be off, as file systems keep it: those that count whole seconds count two at most.
std::int64_t tick_of(std::int64_t time_ns);

/// Whether the status of `file` is not older than the content of `record`, which was written after it: then the file
/// was replaced (cp -p, rsync -t), or rewritten and its time set back. On a file system that counts whole seconds (FAT
/// counts two) it is true rather once too often.
bool touched_since(const FileState& file, const FileState& record);

/// Looks at the files again. Throws changed_error of the first that is not as it was in `files`.
void check_unchanged(std::span<const FileState> files);

}  // namespace weir
