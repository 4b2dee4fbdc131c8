// Events of the files in a watched directory.
#pragma once

#include <string>

namespace weir {

enum class FileEventKind {
  found,      ///< a look found the file: it is new or differs from the last look; nothing is known of its writer
  created,    ///< the name was created, by a program that has the file open or by a link; nothing else is known of the
              ///< writer
  written,    ///< a program writes to the file; its close will be seen
  closed,     ///< a program that had the file open for writing closed it
  moved_in,   ///< the file got this name by a rename
  permitted,  ///< the file's mode, owner or times were set; its content may be unchanged
  marked,     ///< the file's marker is there (WatchConfig::marker); says nothing of the file itself
  removed,    ///< the file is gone, or has another name
  overflow,   ///< events were lost; files that differ are reported as found or removed. `path` is the directory
  root_lost,  ///< the watched directory is not there; `path` is the directory
  root_back   ///< the watched directory is there (again); files that differ from before are reported
};

struct FileEvent {
  FileEventKind kind = FileEventKind::found;
  std::string path;  ///< absolute: WatchConfig::directory or a path below it; may hold any bytes but 0
  bool operator==(const FileEvent&) const = default;
};

}  // namespace weir
