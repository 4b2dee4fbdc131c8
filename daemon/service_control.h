// Answers the calls of the HTTP side from the state file, the running jobs and the watches. One thread: the
// io_context's.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "daemon/http/control.h"
#include "daemon/jobs/job_runner.h"
#include "daemon/log/event_log.h"
#include "daemon/store/disk_turns.h"
#include "daemon/store/job_store.h"
#include "daemon/viewer/job_viewer.h"
#include "daemon/watched_tree.h"

namespace weir {

/// Facts about the service itself.
struct ServiceState {
  std::string version;
  std::string config;  ///< path
  bool stopping = false;
  std::uint64_t reloads = 0;
  std::uint64_t rejected_reloads = 0;
  int jobs = 1;  ///< jobs that run at the same time
};

using WatchedTrees = std::vector<std::unique_ptr<WatchedTree>>;  ///< in the order of the configuration

class ServiceControl final : public Control {
 public:
  /// All arguments must outlive the object.
  ServiceControl(boost::asio::io_context& io, DiskTurns& turns, JobStore& store, JobRunner& runner,
                 const WatchedTrees& trees, JobViewer& viewer, const EventLog& log, const ServiceState& state);

  JobPage jobs(const JobQuery& query) override;
  ProblemPage problems(std::size_t limit) override;
  std::optional<JobView> job(std::int64_t id) override;
  JobChange retry(std::int64_t id, bool force) override;
  std::uint64_t retry_all_failed(const std::string& problem) override;
  JobChange cancel(std::int64_t id) override;
  void pause() override { runner_.pause(); }
  void resume() override { runner_.resume(); }
  StatusView status() override;
  MetricsView metrics() override;
  Readiness readiness() override;
  std::optional<std::string> thumbnail_path(std::int64_t job, std::size_t output) override;
  ViewerView viewer() override { return viewer_.view(); }
  ViewChange view(std::int64_t job, std::size_t output, bool force) override;

 private:
  void retry_some();
  void retry_rest(std::chrono::milliseconds pause);
  std::string waits_for(const Job& job) const;
  void add_rates(StatusView& status) const;
  std::vector<DiskView> disks() const;
  std::vector<RunningView> running() const;
  WatchView watch(const WatchedTree& tree, const std::map<std::string, JobCounts>& counts) const;

  DiskTurns& turns_;
  JobStore& store_;
  JobRunner& runner_;
  const WatchedTrees& trees_;
  JobViewer& viewer_;
  const EventLog& log_;
  const ServiceState& state_;
  double started_at_;
  std::deque<JobStore::Problem> to_retry_;
  boost::asio::steady_timer retry_timer_;
};

}  // namespace weir
