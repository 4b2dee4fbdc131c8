// Runs the real command from outside, as a user does. A test gives arguments and gets the exit code, both output
// streams and the contents of the directory. One thread per object. Nothing here asserts, so that each test says what
// it expects.
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
  std::chrono::milliseconds timeout = std::chrono::seconds(120);  ///< after it the process group is killed
  std::filesystem::path directory;                                ///< working directory; empty: the test's own
  std::vector<std::string> environment;                           ///< "NAME=VALUE", added to the test's own
};

struct CommandResult {
  int exit_code = -1;  ///< the process's exit code, or 128 + signal if a signal ended it
  bool timed_out = false;
  std::string out;  ///< all of stdout
  std::string err;  ///< all of stderr
  /// The kernel's figure (wait4). It starts at the peak of the program that spawned the command, so it is only an upper
  /// bound. A test program of a few MiB does not disturb it.
  std::uint64_t peak_rss_bytes = 0;
};

/// A running command in a process group of its own, with stdin at end of file. The destructor kills it.
class ChildProcess {
 public:
  /// Starts a command; `argv[0]` is looked up in PATH. Throws std::system_error if the command cannot be started.
  explicit ChildProcess(const std::vector<std::string>& argv, CommandOptions options = {});
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const noexcept { return pid_; }
  bool running();
  /// Sends `signal` to the command alone. It is no error if the command has ended.
  void send_signal(int signal);
  /// Waits for the command's end, or for the timeout, which counts from the start.
  CommandResult wait();
  /// Return what the command has written to stdout and stderr so far.
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
/// Runs the `weir` that this test was built with. `arguments` does not include argv[0].
CommandResult run_weir(std::vector<std::string> arguments, const CommandOptions& options = {});

/// Returns everything in `directory` and below, hidden names included, as sorted paths relative to `directory`.
/// Directories have a trailing slash.
std::vector<std::string> list_directory(const std::filesystem::path& directory);
/// Returns the content of a file. Throws std::system_error if it cannot be read.
std::string read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace weir
