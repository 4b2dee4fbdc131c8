// Deletes the sources of watches that say source = "delete-after-verify": the only copy of a result goes last. What
// must hold before:
//   1. the job is done: converted, and every output verified;
//   2. `delete_after` seconds have passed since, and the source is the file that was converted (FileIdentity);
//   3. every output is there with the size it had, and its sidecar says that the source is a single file: data that a
//      header names may be another header's, too, so that such sources stay;
//   4. no program has the source open for writing, or maps it so (file_writers.h). Else it is tried again later.
// Jobs of an earlier process are taken up by configure(). One thread, that of the io_context.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "daemon/config.h"
#include "daemon/event_log.h"
#include "daemon/job_store.h"

namespace weir {

class SourceDeletion {
 public:
  /// `store` and `log` must outlive the object.
  SourceDeletion(boost::asio::io_context& io, const JobStore& store, const EventLog& log);

  /// From now on as `config` says; what is done already waits for the rest of its time.
  void configure(const DaemonConfig& config);
  /// That job is done now.
  void done(std::int64_t id);
  /// Sources that wait to be deleted.
  std::size_t waiting() const { return due_.size(); }

 private:
  using Clock = std::chrono::steady_clock;
  enum class Outcome { over, later };

  void take_up(const WatchConfig& watch);
  void look();
  void arm();
  Outcome look_at(const Job& job, const WatchConfig& watch);
  void keep(const Job& job, const std::string& reason) const;
  const WatchConfig* deleting_watch(const std::string& label) const;

  const JobStore& store_;
  const EventLog& log_;
  std::vector<WatchConfig> watches_;               ///< those that delete
  std::map<std::int64_t, Clock::time_point> due_;  ///< by job
  std::set<std::int64_t> in_use_;                  ///< of which it was said
  boost::asio::steady_timer timer_;
};

}  // namespace weir
