// A child process of the daemon that does one piece of work: in a process group
// of its own (a key pressed at a terminal is for the daemon), with the priority it
// was given, with no descriptor of the daemon's open, and killed as soon as the daemon ends, for whatever reason.
//
// One thread, that of the io_context, which must also be the thread that the
// daemon lives on: the kernel kills the child when the thread that started it ends.
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
  std::vector<std::string> arguments;  ///< the first is the name it goes by
  int nice = 0;
  IoClass io_class = IoClass::none;
  /// How long the end of a worker waits for a child that was killed; one that a hanging file system holds for longer is
  /// reaped when it ends, as long as the io_context runs.
  std::chrono::milliseconds reap_wait{2000};
};

struct WorkerEnd {
  /// The program's own, or 128 + the signal that ended it; that of ErrorKind::internal where the system does not tell,
  /// as the last line of `log` says then.
  int exit_code = 0;
  std::string log;  ///< end of what it wrote to stdout and stderr, WorkerProcess::kLogBytes at most
};

/// Descriptor at which the child finds the pipe for its announcements.
inline constexpr int kAnnounceDescriptor = 3;

class WorkerProcess {
 public:
  static constexpr std::size_t kLogBytes = 8192;

  using Line = std::function<void(std::string_view line)>;  ///< what came on kAnnounceDescriptor
  using Ended = std::function<void(const WorkerEnd& end)>;  ///< once, after the last line; may destroy the worker

  /// Starts the program. Throws Error(io) where that cannot be done.
  WorkerProcess(boost::asio::io_context& io, const WorkerCommand& command, Line line, Ended ended);
  /// Kills what still runs; no callback comes afterwards.
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// Asks it to end (SIGTERM), and ends it (SIGKILL) where it has not after `grace`. Ended comes either way.
  void stop(std::chrono::milliseconds grace);
  /// Bytes resident now; 0 where it has just ended.
  std::uint64_t resident_bytes() const;
  /// Of those what is no page of a file, which the system can take back; 0 likewise.
  std::uint64_t anonymous_bytes() const;
  /// Grows while the process, all its threads counted, computes, reads or writes.
  std::uint64_t activity() const;
  /// As ps says it: 'R' runs, 'S' sleeps, 'D' waits for a device, 'T' was stopped by a signal; 0 where it has just
  /// ended.
  char process_state() const;

 private:
  std::string status_fields() const;

  class Running;
  std::shared_ptr<Running> running_;
};

}  // namespace weir
