// A service that converts nothing: it shows the jobs a test gives it and writes
// down what it was asked to do.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "daemon/control.h"

namespace weir {

class FakeControl : public Control {
 public:
  std::vector<JobView> all;  ///< in the order jobs() gives them
  StatusView now;            ///< counts are those of `all`
  MetricsView figures;
  Readiness readiness_now{true, ""};
  std::map<std::pair<std::int64_t, std::size_t>, std::string> thumbnails;
  std::vector<std::string> asked;       ///< "retry 3", "pause", ...
  std::function<void()> before_answer;  ///< called first by status(); may throw

  JobPage jobs(const JobQuery& query) override {
    JobPage page;
    for (const JobView& job : all) {
      if ((query.state && job.state != *query.state) || (query.watch && job.watch != *query.watch)) continue;
      if (page.total >= query.offset && page.jobs.size() < query.limit) page.jobs.push_back(job);
      ++page.total;
    }
    for (JobView& job : page.jobs) job.log_tail.clear();
    return page;
  }
  std::optional<JobView> job(std::int64_t id) override {
    const auto found = find(id);
    return found == all.end() ? std::nullopt : std::optional(*found);
  }
  JobChange retry(std::int64_t id) override {
    return change(id, "retry ", JobState::waiting, [](JobState s) { return s > JobState::running; });
  }
  std::uint64_t retry_all_failed() override {
    asked.emplace_back("retry all");
    std::uint64_t changed = 0;
    for (JobView& job : all) {
      if (job.state != JobState::failed && job.state != JobState::quarantined) continue;
      job.state = JobState::waiting;
      ++changed;
    }
    return changed;
  }
  JobChange cancel(std::int64_t id) override {
    return change(id, "cancel ", JobState::cancelled, [](JobState s) { return s < JobState::done; });
  }
  void pause() override {
    asked.emplace_back("pause");
    now.state = "paused";
  }
  void resume() override {
    asked.emplace_back("resume");
    now.state = "running";
  }
  StatusView status() override {
    if (before_answer) before_answer();
    StatusView status = now;
    for (const JobView& job : all) ++status.jobs[static_cast<std::size_t>(job.state)];
    return status;
  }
  MetricsView metrics() override { return figures; }
  Readiness readiness() override { return readiness_now; }
  std::optional<std::string> thumbnail_path(std::int64_t job, std::size_t output) override {
    const auto found = thumbnails.find({job, output});
    return found == thumbnails.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  std::vector<JobView>::iterator find(std::int64_t id) {
    return std::find_if(all.begin(), all.end(), [id](const JobView& job) { return job.id == id; });
  }
  JobChange change(std::int64_t id, const std::string& action, JobState state, bool (*fits)(JobState)) {
    const auto found = find(id);
    if (found == all.end()) return JobChange::no_such_job;
    if (!fits(found->state)) return JobChange::wrong_state;
    asked.push_back(action + std::to_string(id));
    found->state = state;
    return JobChange::made;
  }
};

}  // namespace weir
