// Looks through a watched directory a piece at a time, so that nothing else has to wait for a large one.
#pragma once

#include <dirent.h>
#include <sys/stat.h>

#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "daemon/watch/source_table.h"

namespace weir {

class TreeLook {
 public:
  /// Called before a directory is listed, so that the callee can notice changes after the listing. `path` is
  /// relative; empty: the watched directory itself.
  using Entering = std::function<void(const std::string& path)>;

  /// Each entry that is seen goes to `table`, which must outlive the object.
  TreeLook(SourceTable& table, Entering entering) : table_(table), entering_(std::move(entering)) {}

  /// Adds `directory`, and all directories below it that the filter enters, to the look.
  void add(const std::string& directory) { waiting_.push_back(directory); }
  /// Looks at the file or link `path` now if the table wants it.
  void look_at(const std::string& path);
  /// Must be called when `directory` was renamed or removed: drops all entries in it from the look.
  void leave(const std::string& directory);
  void clear();
  /// Looks at some entries, for about a millisecond on a local disk. Returns false when nothing is left to look at.
  bool step();

 private:
  struct CloseDirectory {
    void operator()(DIR* stream) const { ::closedir(stream); }
  };

  void open_next();
  void look_at(const struct stat& status, const std::string& path);

  SourceTable& table_;
  Entering entering_;
  std::deque<std::string> waiting_;
  std::string directory_;
  std::unique_ptr<DIR, CloseDirectory> stream_;
};

}  // namespace weir
