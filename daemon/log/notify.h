// Tells the service manager that the daemon is ready, what it does and that it is alive. Sends the datagrams of
// sd_notify(3) without its library. If $NOTIFY_SOCKET is not set, no call does anything. One thread.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace weir {

class ServiceNotifier {
 public:
  /// Reads and removes $NOTIFY_SOCKET, $WATCHDOG_USEC and $WATCHDOG_PID, so that child processes do not notify in the
  /// daemon's name.
  static ServiceNotifier from_environment();
  /// `socket` is a path, or a name in the abstract namespace with '@' in front. Empty: no manager listens.
  ServiceNotifier(std::string socket, std::optional<std::chrono::microseconds> watchdog)
      : socket_(std::move(socket)), watchdog_(watchdog) {}

  /// Sends lines like "READY=1" and "STATUS=...", separated by newlines. It is no error if the manager does not
  /// listen.
  void send(std::string_view state) const;
  /// Returns the longest time between two messages "WATCHDOG=1"; none if no watchdog waits.
  std::optional<std::chrono::microseconds> watchdog() const { return watchdog_; }

 private:
  std::string socket_;
  std::optional<std::chrono::microseconds> watchdog_;
};

}  // namespace weir
