// Runs the real command from outside, as a user would: arguments in, exit code,
// both output streams and the directory it leaves behind out. One thread per
// object; nothing here asserts, so that a test says itself what it expects.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/temporary_directory.h"

namespace weir {

struct CommandOptions {
  std::chrono::milliseconds timeout = std::chrono::seconds(120);  ///< then the process group is killed
  std::filesystem::path directory;                                ///< working directory; empty: the test's own
  std::vector<std::string> environment;                           ///< "NAME=VALUE", added to the test's own
};

struct CommandResult {
  int exit_code = -1;  ///< the process's own, or 128 + signal where a signal ended it
  bool timed_out = false;
  std::string out;  ///< all of stdout
  std::string err;  ///< all of stderr
  /// The kernel's figure (wait4). It starts at the peak of the program that spawned the command, so
  /// it is an upper bound that a test program of a few MiB does not disturb.
  std::uint64_t peak_rss_bytes = 0;
};

/// A running command in a process group of its own, stdin at end of file. Killed on destruction.
class ChildProcess {
 public:
  /// `argv[0]` is looked up in PATH. Throws std::system_error where it cannot be started.
  explicit ChildProcess(const std::vector<std::string>& argv, CommandOptions options = {});
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const noexcept { return pid_; }
  bool running();
  /// Sends `signal` to the command alone; a command that has ended is not an error.
  void send_signal(int signal);
  /// Waits for the end (or the timeout, counted from the start).
  CommandResult wait();
  /// What it has written so far.
  std::string out_so_far() const;
  std::string err_so_far() const;

 private:
  bool reap(int wait_flags);

  CommandOptions options_;
  std::chrono::steady_clock::time_point start_;
  pid_t pid_ = -1;
  int out_ = -1;
  int err_ = -1;
  std::optional<CommandResult> ended_;
};

CommandResult run_command(const std::vector<std::string>& argv, const CommandOptions& options = {});
/// run_command of the `weir` this test was built with; `arguments` without argv[0].
CommandResult run_weir(std::vector<std::string> arguments, const CommandOptions& options = {});

/// Everything in `directory` and below, hidden names too: paths relative to it, sorted, directories with a
/// trailing slash.
std::vector<std::string> list_directory(const std::filesystem::path& directory);
/// Whole file; throws std::system_error where it cannot be read.
std::string read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace weir
