// A real `weir watch` over its own directories, seen from outside: files go in; results, log and HTTP answers come
// out.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir {

class ServiceHarness {
 public:
  using Json = nlohmann::json;
  static constexpr std::chrono::seconds kPatience{30};

  /// Creates the directories in/ and out/, and a configuration of one watch over them. `service` and `watch` are
  /// lines of TOML with other keys that a test needs ("jobs = 2\n").
  explicit ServiceHarness(std::string service = "", std::string watch = "");
  ~ServiceHarness();
  ServiceHarness(const ServiceHarness&) = delete;
  ServiceHarness& operator=(const ServiceHarness&) = delete;

  /// From now on runs the service as nobody if the test runs as root, because permissions do not stop root.
  void run_unprivileged();
  /// From now on starts the service with SIGCHLD ignored, like a parent program that does not wait for its children.
  void ignore_sigchld() { launcher_ = {"env", "--ignore-signal=CHLD"}; }
  /// Starts `weir watch` and waits until it is ready.
  void start();
  /// Starts the service without waiting.
  void launch();
  /// Sends SIGTERM and waits for the end. Returns the exit code.
  int stop();
  void kill();
  void signal(int signal) { process_->send_signal(signal); }
  bool running() { return process_ && process_->running(); }
  /// Waits for the end. Returns the exit code, and the rest of the result in `result`.
  int wait(CommandResult* result = nullptr);

  std::string in(const std::string& name = "") const { return directory_ / ("in/" + name); }
  std::string out(const std::string& name = "") const { return directory_ / ("out/" + name); }
  std::string path(const std::string& name) const { return directory_ / name; }
  /// Writes the configuration again, with other keys.
  void configure(const std::string& service, const std::string& watch);

  /// Writes in/STEM_24x20x16_uint8.raw with values from `seed`. Returns its name without .raw.
  std::string add(const std::string& stem, int seed = 1) const;
  static std::string volume(int seed);
  static constexpr const char* kSuffix = "_24x20x16_uint8";

  /// Sends a GET or POST request. Returns the JSON answer.
  Json get(const std::string& target) const;
  Json post(const std::string& target) const;
  /// Returns the number of jobs in this state.
  std::uint64_t count(const std::string& state) const;
  /// Returns the job of in/NAME.
  Json job(const std::string& name) const;
  std::string log() const;
  /// Returns the number of log lines with `text`.
  std::size_t logged(const std::string& text) const;

  /// Waits until `holds` returns true, up to `patience`. Returns whether it did.
  static bool eventually(const std::function<bool()>& holds, std::chrono::milliseconds patience = kPatience);
  bool eventually_done(std::uint64_t jobs, std::chrono::milliseconds patience = kPatience) const;

  /// Returns "" if out/STEM.nvdb has the bytes of a plain `weir convert` of in/SOURCE, otherwise the difference.
  std::string difference(const std::string& source, const std::string& output,
                         const std::vector<std::string>& options = {}) const;
  /// Returns the names in out/ that are no results: all except X.nvdb, X.nvdb.json and X.nvdb.png.
  std::vector<std::string> leftovers() const;

 private:
  int port() const;
  std::string request(const std::string& method, const std::string& target) const;

  TemporaryDirectory directory_;
  std::vector<std::string> launcher_;  ///< put before the command
  std::unique_ptr<ChildProcess> process_;
};

}  // namespace weir
