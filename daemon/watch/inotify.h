// One inotify queue, behind an interface that a test can make fail.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace weir {

class Inotify {
 public:
  virtual ~Inotify() = default;
  /// Returns the descriptor, which becomes readable when there are events. This object owns it.
  virtual int descriptor() const = 0;
  /// Watches `directory` for all events of it and of its entries. Returns the watch's number, or -errno if there is
  /// no watch. If the same directory is watched already, returns the number of that watch.
  virtual int add(const std::string& directory) = 0;
  /// Removes a watch. It is no error if the watch does not exist any more.
  virtual void remove(int watch) = 0;
  /// Reads as many whole events (inotify_event and name) as there are and fit. Returns the number of bytes; 0 if
  /// there are no events.
  virtual std::size_t read(std::span<std::byte> events) = 0;
};

/// Opens a queue of the system. Throws Error(io) if the system refuses another queue.
std::unique_ptr<Inotify> open_system_inotify();

using OpenInotify = std::function<std::unique_ptr<Inotify>()>;

}  // namespace weir
