// Reports what happens to the sources in a watched directory, for as long as it lives: every source, and nothing that
// PathFilter refuses. choosing_watch.h makes one.
//
// The directory may be missing, go away, come back or be replaced at any time. What cannot be
// watched (a directory without permission, a link that leaves the tree) is said once, in one line, and
// everything else goes on.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "daemon/config/config.h"
#include "daemon/watch/file_event.h"

namespace weir {

/// Both are called from handlers of the io_context only, never from within a call of the watch; they must not
/// destroy it.
struct WatchListener {
  std::function<void(const FileEvent&)> event;
  std::function<void(const std::string& line)> notice;  ///< for the log: "PATH: what, what to do"
};

struct WatchFigures {
  std::uint64_t overflows = 0;    ///< of the inotify queue
  std::uint64_t directories = 0;  ///< being watched
  std::uint64_t files = 0;        ///< sources there are, as far as known
  bool looked = false;            ///< all that was there at first is known
};

class DirectoryWatch {
 public:
  virtual ~DirectoryWatch() = default;
  /// inotify or poll: what is used now.
  virtual WatchMethod method() const = 0;
  /// Whether the directory is there, as of the last look.
  virtual bool up() const = 0;
  virtual WatchFigures figures() const = 0;
  /// What prevented inotify may be over (a limit was raised): chooses the way to watch again.
  virtual void choose_again() {}
};

}  // namespace weir
