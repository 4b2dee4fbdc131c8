// Tells the service manager that the daemon is ready, what it does and that it is
// alive: the datagrams of sd_notify(3), without its library. Where nobody asked
// ($NOTIFY_SOCKET is not set) every call does nothing. One thread.
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
  /// `socket`: a path, or a name in the abstract space with '@' in front; empty: nobody asked.
  ServiceNotifier(std::string socket, std::optional<std::chrono::microseconds> watchdog)
      : socket_(std::move(socket)), watchdog_(watchdog) {}

  /// Lines like "READY=1" and "STATUS=...", separated by newlines. A manager that does not listen is no error.
  void send(std::string_view state) const;
  /// How often "WATCHDOG=1" must be sent at least; none where no watchdog waits.
  std::optional<std::chrono::microseconds> watchdog() const { return watchdog_; }

 private:
  std::string socket_;
  std::optional<std::chrono::microseconds> watchdog_;
};

}  // namespace weir
