// One source file of one watch, and the state of its conversion.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/store/job_state.h"

namespace weir {

/// Identifies the content of a path. Two equal identities mean the same content to weir.
struct FileIdentity {
  std::uint64_t bytes = 0;
  std::int64_t mtime_ns = 0;  ///< since the epoch; compared for equality only (and for the order of the queue)
  std::uint64_t inode = 0;
  bool operator==(const FileIdentity&) const = default;
};

struct JobOutput {
  std::string path;  ///< absolute, of the .nvdb
  std::uint64_t bytes = 0;
  double rate = 0;                  ///< float32 bytes of the dense volume / bytes of the file
  std::optional<double> psnr_db;    ///< absent if lossless, infinite if lossless over valid voxels alone
  std::optional<double> max_error;  ///< the largest absolute error; absent, like min and max, from an older weir
  std::optional<double> min;        ///< of the source's finite values
  std::optional<double> max;
  std::string thumbnail;  ///< absolute; empty: none
  bool operator==(const JobOutput&) const = default;
};

/// The result of the last attempt.
struct JobResult {
  std::vector<JobOutput> outputs;
  double seconds = 0;
  std::uint64_t source_bytes = 0;  ///< of all files of the source; 0: not known
  std::uint64_t bytes_read = 0;
  std::uint64_t bytes_written = 0;
  std::uint64_t peak_rss_bytes = 0;
  int exit_code = 0;
  std::string reason;    ///< one line; empty if nothing went wrong
  std::string log_tail;  ///< end of what the child wrote to stderr
  bool operator==(const JobResult&) const = default;
};

/// Wall-clock times are in milliseconds since the epoch; 0: never. They are shown and used for sorting. Only the
/// delay after a failure depends on them, and it ends early rather than late when the clock jumps.
struct Job {
  std::int64_t id = 0;  ///< from 1, never reused
  std::string watch;    ///< WatchConfig::label
  std::string source;   ///< absolute path
  std::string options;  ///< text of the options it is converted with, as given to JobStore::observe
  FileIdentity identity;
  JobState state = JobState::discovered;
  bool forced = false;  ///< to be converted again even if its outputs are done
  int attempts = 0;     ///< failed attempts since the last new start by a changed source, changed options or a user
  std::int64_t discovered_ms = 0;  ///< when this identity was first seen
  std::int64_t changed_ms = 0;     ///< when the state last changed or thumbnails came
  std::int64_t queued_ms = 0;      ///< when it became complete
  std::int64_t due_ms = 0;         ///< waiting: does not start before this time
  std::int64_t started_ms = 0;     ///< of the last attempt
  std::int64_t finished_ms = 0;    ///< of the last attempt
  JobResult result;

  /// Returns the size of the source: of all its files if it was converted, otherwise of the watched file.
  std::uint64_t source_bytes() const { return std::max(identity.bytes, result.source_bytes); }
};

}  // namespace weir
