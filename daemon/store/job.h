// One source file of one watch and what became of it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/store/job_state.h"

namespace weir {

/// Which content a path had. Two equal ones are the same content to weir.
struct FileIdentity {
  std::uint64_t bytes = 0;
  std::int64_t mtime_ns = 0;  ///< since the epoch; compared for equality only (and for the order of the queue)
  std::uint64_t inode = 0;
  bool operator==(const FileIdentity&) const = default;
};

struct JobOutput {
  std::string path;  ///< absolute, of the .nvdb
  std::uint64_t bytes = 0;
  double rate = 0;                ///< dense float32 bytes / bytes
  std::optional<double> psnr_db;  ///< absent where lossless, infinite where that is over valid voxels alone
  std::optional<double>
      max_error;              ///< the largest absolute one; this and the next are absent where an older weir wrote
  std::optional<double> min;  ///< of the source's finite values
  std::optional<double> max;
  std::string thumbnail;  ///< absolute; empty: none
  bool operator==(const JobOutput&) const = default;
};

/// What the last attempt left.
struct JobResult {
  std::vector<JobOutput> outputs;
  double seconds = 0;
  std::uint64_t source_bytes = 0;  ///< of all files of the source; 0: not known
  std::uint64_t bytes_read = 0;
  std::uint64_t bytes_written = 0;
  std::uint64_t peak_rss_bytes = 0;
  int exit_code = 0;
  std::string reason;    ///< one line; empty where nothing went wrong
  std::string log_tail;  ///< end of what the child wrote to stderr
  bool operator==(const JobResult&) const = default;
};

/// Wall-clock times are in milliseconds since the epoch, 0: never. They are shown and ordered by; no
/// decision depends on them but the delay after a failure, which ends early rather than late when the clock jumps.
struct Job {
  std::int64_t id = 0;  ///< from 1, never reused
  std::string watch;    ///< WatchConfig::label
  std::string source;   ///< absolute path
  std::string options;  ///< what it is converted with, as given to JobStore::observe
  FileIdentity identity;
  JobState state = JobState::discovered;
  bool forced = false;             ///< to be converted again even where its outputs are done
  int attempts = 0;                ///< failed ones since source, options or a user gave it a new start
  std::int64_t discovered_ms = 0;  ///< this identity first seen
  std::int64_t changed_ms = 0;     ///< state last changed, or thumbnails came
  std::int64_t queued_ms = 0;      ///< became complete
  std::int64_t due_ms = 0;         ///< waiting: not before
  std::int64_t started_ms = 0;     ///< of the last attempt
  std::int64_t finished_ms = 0;    ///< of the last attempt
  JobResult result;

  /// Of the source: of all its files where it was converted, else of the one that is watched.
  std::uint64_t source_bytes() const { return std::max(identity.bytes, result.source_bytes); }
};

}  // namespace weir
