// A real `weir watch` over directories of its own, seen from outside: files go
// in, results, log and HTTP answers come out.
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

  /// The directories in/ and out/, and a configuration of one watch over them. Keys that a test needs otherwise are
  /// said by `service` and `watch`, lines of TOML ("jobs = 2\n").
  explicit ServiceHarness(std::string service = "", std::string watch = "");
  ~ServiceHarness();
  ServiceHarness(const ServiceHarness&) = delete;
  ServiceHarness& operator=(const ServiceHarness&) = delete;

  /// From now on the service runs as nobody, whom permissions stop, where the test runs as root, whom they do not.
  void run_unprivileged();
  /// From now on the service is started with SIGCHLD ignored, as by a program that does not wait for its children.
  void ignore_sigchld() { launcher_ = {"env", "--ignore-signal=CHLD"}; }
  /// Starts `weir watch` and waits until it is ready.
  void start();
  /// Starts it without waiting.
  void launch();
  /// SIGTERM, and the end; the exit code.
  int stop();
  void kill();
  void signal(int signal) { process_->send_signal(signal); }
  bool running() { return process_ && process_->running(); }
  /// Waits for the end; the exit code. `result`: where the rest of it goes.
  int wait(CommandResult* result = nullptr);

  std::string in(const std::string& name = "") const { return directory_ / ("in/" + name); }
  std::string out(const std::string& name = "") const { return directory_ / ("out/" + name); }
  std::string path(const std::string& name) const { return directory_ / name; }
  /// Writes the configuration again, with other keys.
  void configure(const std::string& service, const std::string& watch);

  /// in/STEM_24x20x16_uint8.raw with values from `seed`; its stem with dimensions.
  std::string add(const std::string& stem, int seed = 1) const;
  static std::string volume(int seed);
  static constexpr const char* kSuffix = "_24x20x16_uint8";

  /// GET or POST; the JSON answer.
  Json get(const std::string& target) const;
  Json post(const std::string& target) const;
  /// Number of jobs in that state.
  std::uint64_t count(const std::string& state) const;
  /// The job of in/NAME.
  Json job(const std::string& name) const;
  std::string log() const;
  /// Lines of the log with `text`.
  std::size_t logged(const std::string& text) const;

  /// Waits up to `patience`; whether it came to hold.
  static bool eventually(const std::function<bool()>& holds, std::chrono::milliseconds patience = kPatience);
  bool eventually_done(std::uint64_t jobs, std::chrono::milliseconds patience = kPatience) const;

  /// Empty where out/STEM.nvdb has the bytes of a plain `weir convert` of in/SOURCE; else what is wrong.
  std::string difference(const std::string& source, const std::string& output,
                         const std::vector<std::string>& options = {}) const;
  /// Names in out/ that are no result: anything but X.nvdb, X.nvdb.json and X.nvdb.png.
  std::vector<std::string> leftovers() const;

 private:
  int port() const;
  std::string request(const std::string& method, const std::string& target) const;

  TemporaryDirectory directory_;
  std::vector<std::string> launcher_;  ///< before the command
  std::unique_ptr<ChildProcess> process_;
};

}  // namespace weir
