// Reports the events of the sources in a watched directory as long as the object lives: of every source, and of no
// file that PathFilter refuses. choosing_watch.h creates the object.
//
// The directory may be missing, go away, come back or be replaced at any time. A part that cannot be watched (a
// directory without permission, a link that leaves the tree) is reported once, in one line; everything else goes on.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "daemon/config/config.h"
#include "daemon/watch/file_event.h"

namespace weir {

/// Both functions are called only from handlers of the io_context, never from within a call of the watch. They must
/// not destroy the watch.
struct WatchListener {
  std::function<void(const FileEvent&)> event;
  std::function<void(const std::string& line)> notice;  ///< for the log: "PATH: what, what to do"
};

struct WatchFigures {
  std::uint64_t overflows = 0;    ///< of the inotify queue
  std::uint64_t directories = 0;  ///< that are watched
  std::uint64_t files = 0;        ///< known sources
  bool looked = false;            ///< the first look at the directory has ended
};

class DirectoryWatch {
 public:
  virtual ~DirectoryWatch() = default;
  /// Returns the method in use: inotify or poll.
  virtual WatchMethod method() const = 0;
  /// Returns whether the directory was there at the last look.
  virtual bool up() const = 0;
  virtual WatchFigures figures() const = 0;
  /// Chooses the method again, because what prevented inotify may be over (for example, a limit was raised).
  virtual void choose_again() {}
};

}  // namespace weir
