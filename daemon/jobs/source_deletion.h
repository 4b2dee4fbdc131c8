// Deletes the sources of watches that say source = "delete-after-verify". The source may be the only copy of a
// result, so it is deleted last. All this must hold before:
//   1. The job is done: converted and every output verified, by the options that the watch has now. The watch still
//      accepts its source.
//   2. `delete_after` seconds have passed since, in this process and under this delay. The source is the file that
//      was converted: it has the same size, time and inode (FileIdentity), and its status change time is not later
//      than its certificate.
//   3. Every output exists with its recorded size, and its certificate names this source, and this file alone. Data
//      that a header names may belong to another header, too, so a source in several files stays. A source that
//      stands for a directory (the Header of a plotfile, the metadata of a Zarr hierarchy) stays whatever its
//      certificate says. The outputs together have as many voxels as the source has values: otherwise the source
//      holds volumes that nothing else holds.
//   4. No program has the source open for writing or maps it writable (file_writers.h); otherwise the deletion is
//      tried again later. If this cannot be known, the source is deleted only if its writer says when it is done
//      (says_when_done). A program that opens the source during this check gets the whole file: the source already
//      has a hidden name when the last check is made.
//   5. The outputs, and the directories that were made for them, are flushed to disk.
// The source's marker is deleted before the source; if the source gets its name back, the marker is made again. Jobs
// of an earlier process are taken up a few at a time. A deletion that a kill interrupted is finished. If the watch no
// longer deletes, or the job is to be done again, the source gets its name back. A hidden source without a job is
// logged and stays. One thread: the io_context's.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/jobs/hidden_sources.h"
#include "daemon/log/event_log.h"
#include "daemon/store/job_store.h"
#include "daemon/watch/file_writers.h"
#include "format/io/file_system.h"
#include "ingest/files/file_state.h"

namespace weir {

class SourceDeletion {
 public:
  using Held = std::function<bool()>;
  /// `store` and `log` must outlive the object. Nothing is deleted while `held`, if given, returns true. `files` is
  /// for tests.
  SourceDeletion(boost::asio::io_context& io, const JobStore& store, const EventLog& log, Held held = {},
                 std::unique_ptr<FileSystem> files = make_posix_file_system());

  /// Uses the watches of `config` from now on. If a watch's delay has changed, its done jobs wait for the whole new
  /// delay.
  void configure(const DaemonConfig& config);
  /// Must be called when the job `id` is done.
  void done(std::int64_t id);
  /// Returns whether no source waits to be deleted and all jobs have been looked through.
  bool idle() const { return due_.empty() && !taking_up_; }

 private:
  using Clock = std::chrono::steady_clock;
  enum class Outcome { over, later };
  struct Due {
    Clock::time_point time;
    std::string watch;  // WatchConfig::label
  };

  void work();
  void take_up();
  void look();
  bool waits_for_disks(const WatchConfig& watch);
  void arm();
  void wait_until(Clock::time_point time);
  Outcome try_to_delete(const Job& job, const WatchConfig& watch);
  Outcome look_at(const Job& job, const WatchConfig& watch);
  void flush_outputs(const Job& job, const WatchConfig& watch) const;
  std::optional<FileState> state_since_certified(const Job& job) const;
  Outcome wait_for(const Job& job, const std::string& reason);
  void give_name_back(const Job& job);
  Outcome remove(const Job& job, const FileWriters& writers);
  Outcome remove_hidden(const Job& job, bool writers_known);
  std::string marker_of(const Job& job) const;
  void mark_again(const Job& job) const;
  Outcome finish_interrupted(const Job& job, const WatchConfig& watch);
  void uncover(const HiddenSource& hidden) const;
  void keep(const Job& job, const std::string& reason) const;
  const WatchConfig* deleting_watch(const std::string& label) const;

  const JobStore& store_;
  const EventLog& log_;
  Held held_;
  std::vector<WatchConfig> watches_;               ///< watches that delete their sources
  std::map<std::string, std::string> markers_;     ///< WatchConfig::marker by label, of watches that wait for a marker
  std::map<std::int64_t, Due> due_;                ///< by job
  std::set<std::string> away_;                     ///< labels of watches whose missing disks were logged
  std::map<std::int64_t, std::string> waits_for_;  ///< by job: the reason for waiting that was logged last
  std::map<std::int64_t, std::int64_t>
      named_back_;  ///< by job: FileState::ctime_ns of sources that got their name back
  bool taking_up_ = false;
  std::int64_t taken_up_ = 0;  ///< id of the last job that was looked through
  HiddenSources hidden_;
  std::unique_ptr<FileSystem> files_;
  boost::asio::steady_timer timer_;
};

}  // namespace weir
