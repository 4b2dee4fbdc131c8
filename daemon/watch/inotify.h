// One queue of inotify, behind an interface that a test can make fail.
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
  /// Becomes readable when there are events. Owned by this object.
  virtual int descriptor() const = 0;
  /// Watches `directory` for all that happens to it and to its entries. The watch's number, which is that of an
  /// earlier one of the same directory; -errno where there is none.
  virtual int add(const std::string& directory) = 0;
  /// A watch that is no more is no error.
  virtual void remove(int watch) = 0;
  /// Whole events (inotify_event and name), as many as there are and fit; the bytes, 0 where there are none.
  virtual std::size_t read(std::span<std::byte> events) = 0;
};

/// The system's. Throws Error(io) where it gives no further queue.
std::unique_ptr<Inotify> open_system_inotify();

using OpenInotify = std::function<std::unique_ptr<Inotify>()>;

}  // namespace weir
