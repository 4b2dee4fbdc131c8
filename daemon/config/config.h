// The configuration of `weir watch CONFIG.toml` in memory: one service and any number of watched directories.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/listen_address.h"
#include "daemon/config/priority.h"

namespace weir {

enum class IoClass { none, best_effort, idle };  ///< none: the class of the daemon itself

/// The table [service]. Paths are absolute.
struct ServiceConfig {
  std::string state;                        ///< SQLite file; default: weir.db, see load_config
  ListenAddress listen{"127.0.0.1", 8470};  ///< port 0: any free port, see port_file
  std::string control_socket;  ///< path of a Unix socket; empty: none. If set, only it serves POST and viewers
  std::string port_file;       ///< file to which the bound port is written; empty: none
  std::string token_file;      ///< file that `token` was read from; empty: the key `token` gave it, or there is none
  std::string token;           ///< bearer token; never empty if other machines may connect to `listen`
  std::uint64_t memory = std::uint64_t{1} << 30;           ///< bytes for the daemon, all jobs and the viewer together
  std::uint64_t viewer_memory = std::uint64_t{192} << 20;  ///< the viewer's bytes of `memory`; 0: no viewer
  bool is_standard_viewer = false;                         ///< viewer_memory is the default
  int jobs = 1;                                            ///< concurrent conversions
  int threads = 0;                                         ///< threads of each job; 0: all of the machine
  int nice = 0;                                            ///< niceness of the jobs, 0 to 19
  IoClass io_class = IoClass::none;                        ///< I/O class of the jobs
  std::uint64_t bandwidth = 0;     ///< bytes per second that all conversions together may read and write; 0: no limit
  std::string work_dir;            ///< spill files; empty: a hidden directory beside each output
  double grace_s = 30;             ///< seconds that a running job may go on after SIGTERM
  double history_days = 90;        ///< days after its end for which a job is kept if its source is deleted
  std::string log_file;            ///< key `log`; empty: stderr
  std::string log_level = "info";  ///< trace, debug, info, warn, error or off
  std::uint64_t log_size = std::uint64_t{10} << 20;  ///< bytes at which the log file is rotated; 0: never
  int log_files = 5;                                 ///< rotated files kept
};

/// Bytes of `memory` for the daemon itself.
inline constexpr std::uint64_t kDaemonMemory = std::uint64_t{64} << 20;

inline constexpr std::uint64_t kLeastViewerMemory = std::uint64_t{128} << 20;
/// From this size on, the viewer forecasts what conversions for a scene would yield. A forecast needs 64 MiB or more.
inline constexpr std::uint64_t kForecastingViewerMemory = std::uint64_t{192} << 20;
inline constexpr std::uint64_t kMostStandardViewerMemory = std::uint64_t{512} << 20;

/// Returns `viewer_memory` for a configuration without it: an eighth of `memory`, at most kMostStandardViewerMemory. An
/// eighth below kForecastingViewerMemory is raised to it if a job still gets `least_job` bytes. 0 if the eighth is less
/// than kLeastViewerMemory or leaves a job less than `least_job` bytes.
std::uint64_t standard_viewer_memory(const ServiceConfig& service, std::uint64_t least_job);

/// Returns why there is no viewer: where viewer_memory = 0 comes from. If it is the default, also returns the remedy.
std::string no_viewer_reason(const ServiceConfig& service);

/// Returns the most bytes of memory that one job may use: an equal share of what the daemon and the viewer leave.
std::uint64_t job_memory(const ServiceConfig& service);

enum class Completion { automatic, close, rename, marker, size, stable };
enum class WatchMethod { automatic, inotify, poll };
enum class AfterDone { keep, delete_after_verify };
enum class Follow { inside, anywhere };  ///< where files that a source names may lie

/// Returns whether the writer itself says that a file is complete, by a rename or by a marker.
constexpr bool says_when_done(Completion completion) {
  return completion == Completion::rename || completion == Completion::marker;
}

/// All files whose path is `before`, then a whole number, then `after`.
struct NumberedFiles {
  std::string before;  ///< absolute
  std::string after;
  bool any_after = false;  ///< anything may follow the number
  bool operator==(const NumberedFiles&) const = default;
};

/// One table [[watch]]. Directories are absolute and lexically normal, without a trailing slash.
struct WatchConfig {
  std::string label;      ///< unique; names the watch in state, logs and metrics; default: its directory
  std::string directory;  ///< need not exist yet
  bool recursive = false;
  std::string output;                ///< a recursive watch repeats its subdirectories below it
  std::string output_mount;          ///< `output` or a parent; jobs wait while nothing is mounted there; empty: none
  std::string name;                  ///< template of output names, "{stem}.nvdb"; empty: convert's default
  std::vector<std::string> include;  ///< globs; empty: names of known formats, see PathFilter
  std::vector<std::string> exclude;  ///< globs
  /// Absolute paths in `directory` that are never sources, nor is anything below them: outputs of every watch, the work
  /// directory, the service's own files.
  std::vector<std::string> excluded_paths;
  std::vector<NumberedFiles> excluded_numbers;  ///< likewise: rotated logs, state files that were moved aside
  Completion complete = Completion::automatic;
  std::string marker = ".done";  ///< appended to a source's name
  double settle_s = 2;           ///< seconds for which size and mtime must be unchanged
  WatchMethod watch = WatchMethod::automatic;
  double poll_interval_s = 1;
  Priority priority = Priority::oldest;
  AfterDone source = AfterDone::keep;
  double delete_after_s = 600;      ///< seconds between the end of a job and the deletion of its source
  bool gives_delete_after = false;  ///< delete_after is in the configuration
  Follow follow = Follow::inside;   ///< inside: in `directory` or below, with symbolic links resolved
  bool thumbnails = true;
  std::vector<std::string> convert_options;  ///< arguments of `weir convert`, as read_watch_options() writes them

  /// Returns the value of --NAME in convert_options ("true" for a flag); nullopt if the option is not given.
  std::optional<std::string> convert_option(std::string_view option) const;
  /// Returns whether every NAME.raw is a source if `include` is empty, because dims or type is given. A file whose name
  /// lacks the other of the two becomes a job that fails and says what is missing.
  bool takes_any_raw() const;
  /// Returns a message on a key that has no effect beside the others, and what to do; empty if there is no such key.
  std::string unused_key() const;
  bool operator==(const WatchConfig&) const = default;
};

struct DaemonConfig {
  std::string path;  ///< absolute
  ServiceConfig service;
  std::vector<WatchConfig> watches;
};

}  // namespace weir
