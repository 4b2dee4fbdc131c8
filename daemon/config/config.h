// What `weir watch CONFIG.toml` is asked to do: one service, any number of
// watched directories.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/listen_address.h"
#include "daemon/config/priority.h"

namespace weir {

enum class IoClass { none, best_effort, idle };  ///< none: as the daemon itself

/// [service]. Paths are absolute.
struct ServiceConfig {
  std::string state;                              ///< SQLite file; default: weir.db, see load_config
  ListenAddress listen{"127.0.0.1", 8470};        ///< port 0: any free one, see port_file
  std::string control_socket;                     ///< Unix socket; empty: none. With it, `listen` only shows
  std::string port_file;                          ///< the port that was bound is written there; empty: nowhere
  std::string token_file;                         ///< that `token` was read from; empty: it is in the configuration
  std::string token;                              ///< bearer token; never empty where others than loopback may connect
  std::uint64_t memory = std::uint64_t{1} << 30;  ///< bytes, the daemon, all jobs and the viewer together
  std::uint64_t viewer_memory = std::uint64_t{192} << 20;  ///< bytes of it for the viewer; 0: there is none
  bool is_standard_viewer = false;                         ///< viewer_memory is not in the configuration
  int jobs = 1;                                            ///< concurrent conversions
  int threads = 0;                                         ///< of each job; 0: all of the machine's
  int nice = 0;                                            ///< of the jobs, 0 to 19
  IoClass io_class = IoClass::none;                        ///< of the jobs
  std::uint64_t bandwidth = 0;     ///< bytes per second that all conversions together may read and write; 0: no limit
  std::string work_dir;            ///< spill files; empty: a hidden directory beside each output
  double grace_s = 30;             ///< what a running job is given after SIGTERM
  double history_days = 90;        ///< that jobs of deleted sources are kept for after their end
  std::string log_file;            ///< key `log`; empty: stderr
  std::string log_level = "info";  ///< trace, debug, info, warn, error or off
  std::uint64_t log_size = std::uint64_t{10} << 20;  ///< bytes at which the log file is rotated; 0: never
  int log_files = 5;                                 ///< rotated files kept
};

/// Taken from `memory` for the daemon itself.
inline constexpr std::uint64_t kDaemonMemory = std::uint64_t{64} << 20;

inline constexpr std::uint64_t kLeastViewerMemory = std::uint64_t{128} << 20;
/// From here on the viewer says what conversions for a scene would come to: those take at least 64 MiB.
inline constexpr std::uint64_t kForecastingViewerMemory = std::uint64_t{192} << 20;
inline constexpr std::uint64_t kMostStandardViewerMemory = std::uint64_t{512} << 20;

/// `viewer_memory` where the configuration gives none: an eighth of `memory`, kMostStandardViewerMemory at most; where
/// that is less than kForecastingViewerMemory, but not than kLeastViewerMemory, the former, or else the eighth; 0 where
/// it leaves a job less than `least_job` bytes.
std::uint64_t standard_viewer_memory(const ServiceConfig& service, std::uint64_t least_job);

/// Why there is no viewer: what viewer_memory = 0 comes from and, where it is standard_viewer_memory()'s, the remedy.
std::string no_viewer_reason(const ServiceConfig& service);

/// The ceiling of one job in bytes: an equal share of what the daemon and the viewer leave.
std::uint64_t job_memory(const ServiceConfig& service);

enum class Completion { automatic, close, rename, marker, size, stable };
enum class WatchMethod { automatic, inotify, poll };
enum class AfterDone { keep, delete_after_verify };
enum class Follow { inside, anywhere };  ///< where the files may lie that a source names

/// Whether the writer itself says that a file is done: by a rename, or by a marker.
constexpr bool says_when_done(Completion completion) {
  return completion == Completion::rename || completion == Completion::marker;
}

/// BEFORE, a whole number, AFTER.
struct NumberedFiles {
  std::string before;  ///< absolute
  std::string after;
  bool any_after = false;  ///< anything may follow the number
  bool operator==(const NumberedFiles&) const = default;
};

/// One [[watch]]. Directories are absolute and lexically normal, without a trailing slash.
struct WatchConfig {
  std::string label;      ///< unique; names the watch in state, logs and metrics; default: its directory
  std::string directory;  ///< need not exist yet
  bool recursive = false;
  std::string output;        ///< sub-directories of a recursive watch are repeated below it
  std::string output_mount;  ///< `output` is here or below; jobs wait while nothing is mounted here; empty: none
  std::string name;          ///< template of output names, "{stem}.nvdb"; empty: convert's default
  std::vector<std::string> include;  ///< globs; empty: names of known formats, see PathFilter
  std::vector<std::string> exclude;  ///< globs
  /// Absolute; these and all below them are never sources: outputs of every watch, work directory, the
  /// service's own files. Only what lies in `directory`.
  std::vector<std::string> excluded_paths;
  std::vector<NumberedFiles> excluded_numbers;  ///< as excluded_paths: rotated logs, state files that were moved aside
  Completion complete = Completion::automatic;
  std::string marker = ".done";  ///< appended to a source's name
  double settle_s = 2;           ///< size and mtime unchanged for so long
  WatchMethod watch = WatchMethod::automatic;
  double poll_interval_s = 1;
  Priority priority = Priority::oldest;
  AfterDone source = AfterDone::keep;
  double delete_after_s = 600;      ///< between the end of a job and the deletion of its source
  bool gives_delete_after = false;  ///< delete_after is in the configuration
  Follow follow = Follow::inside;   ///< inside: in `directory` and below, symbolic links resolved
  bool thumbnails = true;
  std::vector<std::string> convert_options;  ///< arguments of `weir convert`, as read_watch_options() writes them

  /// The value of --NAME in convert_options ("true" of a flag); nullopt where it is not given.
  std::optional<std::string> convert_option(std::string_view option) const;
  /// Whether any file NAME.raw is a source where `include` is empty: dims or type is given, so that a file whose name
  /// does not say the other one is a job that says what is missing.
  bool takes_any_raw() const;
  /// Of a key that has no effect beside the others, and what to do; empty: there is none.
  std::string unused_key() const;
  bool operator==(const WatchConfig&) const = default;
};

struct DaemonConfig {
  std::string path;  ///< absolute
  ServiceConfig service;
  std::vector<WatchConfig> watches;
};

}  // namespace weir
