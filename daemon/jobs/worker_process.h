// A child process of the daemon that does one piece of work. It has its own process group (a key pressed at a
// terminal reaches only the daemon), its own priority and none of the daemon's open descriptors. The kernel kills it
// when the daemon ends for any reason.
//
// One thread: the io_context's. It must live as long as the daemon, because the kernel kills the child when the
// thread that started it ends.
#pragma once

#include <sys/types.h>

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/config.h"

namespace weir {

struct WorkerCommand {
  std::string program;                 ///< path
  std::vector<std::string> arguments;  ///< the first is the name of the program (argv[0])
  int nice = 0;
  IoClass io_class = IoClass::none;
  /// How long the destructor waits for a killed child to end. If a hanging file system holds the child for longer,
  /// the child is reaped when it ends, as long as the io_context runs.
  std::chrono::milliseconds reap_wait{2000};
};

struct WorkerEnd {
  /// The program's own exit code, or 128 + the signal that ended it. If the system does not report how the child
  /// ended, this is the exit code of ErrorKind::internal, and the last line of `log` says so.
  int exit_code = 0;
  std::string log;  ///< the end of the child's stdout and stderr, at most WorkerProcess::kLogBytes
};

/// Descriptor at which the child finds the pipe for its announcements.
inline constexpr int kAnnounceDescriptor = 3;

class WorkerProcess {
 public:
  static constexpr std::size_t kLogBytes = 8192;

  using Line =
      std::function<void(std::string_view line)>;  ///< called with each line that arrives on kAnnounceDescriptor
  using Ended =
      std::function<void(const WorkerEnd& end)>;  ///< called once, after the last line; may destroy the worker

  /// Starts the program. Throws Error(io) if the program cannot be started.
  WorkerProcess(boost::asio::io_context& io, const WorkerCommand& command, Line line, Ended ended);
  /// Kills the process if it still runs; no callback is called afterwards.
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// Asks the process to end (SIGTERM), and kills it (SIGKILL) if it still runs after `grace`. `ended` is called in
  /// both cases.
  void stop(std::chrono::milliseconds grace);
  /// Returns the resident bytes; 0 if the process has just ended.
  std::uint64_t resident_bytes() const;
  /// Returns the resident bytes that are not pages of a file (the system can take back those); 0 if the process has
  /// just ended.
  std::uint64_t anonymous_bytes() const;
  /// Returns a number that grows while any thread of the process computes, reads or writes.
  std::uint64_t activity() const;
  /// Returns the state letter of ps: 'R' runs, 'S' sleeps, 'D' waits for a device, 'T' was stopped by a signal; 0 if
  /// the process has just ended.
  char process_state() const;

 private:
  std::string status_fields() const;

  class Running;
  std::shared_ptr<Running> running_;
};

}  // namespace weir
