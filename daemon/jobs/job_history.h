// Forgets jobs that are long over and whose sources are gone, so that the state
// file does not grow for as long as the simulation runs. A source that is there
// keeps its job, however old: it is what says that the source is converted. One
// thread, that of the io_context.
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

  /// From now on jobs are kept for `days` after their end, and longer while the directory of their watch is not there.
  /// Looks through all of them now and once a day.
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
