// Deletes the sources of watches that say source = "delete-after-verify": the only copy of a result goes last. What
// must hold before:
//   1. the job is done, converted and every output verified, by the options that the watch has now, and the watch
//      still takes its source;
//   2. `delete_after` seconds have passed since, in this process and under this delay, and the source is the file that
//      was converted: by size, time and inode (FileIdentity), and no status of it is younger than its certificate;
//   3. every output is there with the size it had, and its certificate is of this source, and of this file alone:
//      data that a header names may be another header's, too, so that such sources stay, and a source that stands for
//      a directory (the Header of a plotfile, the metadata of a Zarr hierarchy) stays whatever its certificate says.
//      Together they have as many voxels as the source has values: its other volumes would go with it;
//   4. no program has the source open for writing, or maps it so (file_writers.h): else it is tried again later.
//      Where that cannot be known, the writer must say itself that it is done (says_when_done). One that opens it while
//      it is looked at gets it whole: the source has lost its name when this is looked at last;
//   5. the outputs are on their disk, with the directories that were made for them.
// Its marker is deleted with it, and before it; where the source gets its name back, the marker is made again.
// Jobs of an earlier process are taken up a few at a time; a deletion that it was killed in is finished. Where the
// watch deletes no more, or the job is to be done again, the source gets its name back; what no job knows is told of
// and stays. One thread, that of the io_context.
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
  /// `store` and `log` must outlive the object. Nothing is deleted while `held`, where there is one. `files`: for
  /// tests.
  SourceDeletion(boost::asio::io_context& io, const JobStore& store, const EventLog& log, Held held = {},
                 std::unique_ptr<FileSystem> files = make_posix_file_system());

  /// From now on as `config` says; what is done already waits for the whole of its time again where that has changed.
  void configure(const DaemonConfig& config);
  /// That job is done now.
  void done(std::int64_t id);
  /// Whether no source waits to be deleted, and all jobs have been looked through.
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
  bool waits_for_directory(const WatchConfig& watch);
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
  std::vector<WatchConfig> watches_;               ///< those that delete
  std::map<std::string, std::string> markers_;     ///< WatchConfig::marker by label, of those that wait for one
  std::map<std::int64_t, Due> due_;                ///< by job
  std::set<std::string> away_;                     ///< labels of watches whose directory was said to be missing
  std::map<std::int64_t, std::string> waits_for_;  ///< by job: what was said of it
  std::map<std::int64_t, std::int64_t>
      named_back_;  ///< by job: FileState::ctime_ns of sources that got their name back
  bool taking_up_ = false;
  std::int64_t taken_up_ = 0;  ///< id of the last job that was looked through
  HiddenSources hidden_;
  std::unique_ptr<FileSystem> files_;
  boost::asio::steady_timer timer_;
};

}  // namespace weir
