// Forgets jobs that ended long ago and whose sources are gone, so that the state file does not grow for as long as
// the simulation runs. A source that still exists keeps its job, however old, because the job records that the source
// is converted. One thread: the io_context's.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "daemon/config/config.h"
#include "daemon/log/event_log.h"
#include "daemon/store/disk_turns.h"
#include "daemon/store/job_store.h"

namespace weir {

class JobHistory {
 public:
  /// `store` and `log` must outlive the object.
  JobHistory(boost::asio::io_context& io, DiskTurns& turns, JobStore& store, const EventLog& log);

  /// From now on keeps each job for `days` after its end. Jobs of a watch are also kept while its directory is
  /// missing. Looks through all jobs now and then once a day.
  void keep(double days, std::span<const WatchConfig> watches);

 private:
  void look_through();
  void step();
  void after(std::chrono::milliseconds delay, void (JobHistory::*next)());
  bool is_over(const Job& job) const;

  DiskTurns& turns_;
  JobStore& store_;
  const EventLog& log_;
  std::int64_t age_ms_ = 0;
  std::map<std::string, std::string> directories_;  ///< by the label of the watch
  std::int64_t at_ = 0;                             ///< id of the last job looked at
  std::uint64_t forgotten_ = 0;
  boost::asio::steady_timer timer_;
};

}  // namespace weir
