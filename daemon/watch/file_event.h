// What becomes known of a file in a watched directory.
#pragma once

#include <string>

namespace weir {

enum class FileEventKind {
  found,      ///< seen by looking: it is new, or differs from what was seen before; nothing is known of its writer
  created,    ///< its name was made, by a program that has it open or by a link; nothing else is known of its writer
  written,    ///< a program writes to it; its close will be seen
  closed,     ///< a program that had it open for writing closed it
  moved_in,   ///< it got this name by a rename
  permitted,  ///< its mode, owner or times were set; says nothing of its content
  marked,     ///< its marker is there (WatchConfig::marker); says nothing of the file itself
  removed,    ///< it is gone, or has another name
  overflow,   ///< events were lost; whatever differs is reported as found or removed. `path` is the directory
  root_lost,  ///< the watched directory is not there; `path` is the directory
  root_back   ///< it is there (again); whatever differs from before is reported
};

struct FileEvent {
  FileEventKind kind = FileEventKind::found;
  std::string path;  ///< absolute, WatchConfig::directory and what lies below it; any bytes but 0
  bool operator==(const FileEvent&) const = default;
};

}  // namespace weir
