// A service that converts nothing: it returns the jobs that a test sets, and records the requests.
#pragma once

#include <algorithm>
#include <cctype>
#include <functional>
#include <string>
#include <vector>

#include "daemon/http/control.h"
#include "daemon/store/problem_key.h"

namespace weir {

class FakeControl : public Control {
 public:
  std::vector<JobView> all;   ///< in the order that jobs() returns them
  StatusView now;             ///< the job counts are taken from `all`
  bool stays_paused = false;  ///< stays paused when it is resumed, because a fault holds all jobs
  MetricsView figures;
  Readiness readiness_now{true, ""};
  std::map<std::pair<std::int64_t, std::size_t>, std::string> thumbnails;
  bool view_taken = false;              ///< somebody looks at another series
  std::vector<std::string> asked;       ///< "retry 3", "pause", ...
  JobQuery asked_for;                   ///< the query of the last call of jobs()
  std::function<void()> before_answer;  ///< called first by status(); may throw

  JobPage jobs(const JobQuery& query) override {
    asked_for = query;
    JobPage page;
    for (const JobView& job : all) {
      if (matches(job, query)) page.jobs.push_back(job);
    }
    page.total = page.jobs.size();
    if (query.order || !query.problem.empty()) sort(page.jobs, query.order.value_or(JobOrder{}));
    page.jobs.erase(page.jobs.begin(),
                    page.jobs.begin() + static_cast<std::ptrdiff_t>(std::min(query.offset, page.jobs.size())));
    page.jobs.resize(std::min(query.limit, page.jobs.size()));
    for (JobView& job : page.jobs) job.log_tail.clear();
    return page;
  }
  std::optional<JobView> job(std::int64_t id) override {
    const auto found = find(id);
    return found == all.end() ? std::nullopt : std::optional(*found);
  }
  JobChange retry(std::int64_t id, bool force) override {
    return change(id, force ? "force " : "retry ", JobState::waiting, [](JobState s) { return s > JobState::running; });
  }
  ProblemPage problems(std::size_t limit) override {
    ProblemPage page;
    for (const JobView& job : all) {
      if (!is_problem(job)) continue;
      ++page.total;
      const std::string key = key_of(job);
      const auto group = std::find_if(page.groups.begin(), page.groups.end(),
                                      [&](const ProblemView& known) { return known.key == key; });
      if (group != page.groups.end()) {
        ++group->count;
      } else {
        page.groups.push_back({key, 1, job});
      }
    }
    for (ProblemView& group : page.groups) {
      for (const JobView& job : all) {
        if (is_problem(job) && key_of(job) == group.key && job.changed_at > group.newest.changed_at) group.newest = job;
      }
    }
    std::stable_sort(page.groups.begin(), page.groups.end(), [](const ProblemView& a, const ProblemView& b) {
      return a.newest.changed_at > b.newest.changed_at;
    });
    page.groups.resize(std::min(limit, page.groups.size()));
    return page;
  }
  std::uint64_t retry_all_failed(const std::string& problem) override {
    asked.push_back(problem.empty() ? "retry all" : "retry problem " + problem);
    std::uint64_t changed = 0;
    for (JobView& job : all) {
      if (!is_problem(job) || (!problem.empty() && key_of(job) != problem)) continue;
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
    now.state = stays_paused ? "paused" : "running";
  }
  StatusView status() override {
    if (before_answer) before_answer();
    StatusView status = now;
    for (const JobView& job : all) ++status.jobs[static_cast<std::size_t>(job.state)];
    return status;
  }
  MetricsView metrics() override { return figures; }
  Readiness readiness() override { return readiness_now; }
  ViewerView viewer() override { return now.viewer; }
  ViewChange view(std::int64_t job, std::size_t output, bool force) override {
    const auto found = find(job);
    if (found == all.end()) return ViewChange::no_such_job;
    if (found->state != JobState::done) return ViewChange::wrong_state;
    if (output >= found->outputs.size()) return ViewChange::no_such_output;
    if (now.viewer.state == ViewerState::off) return ViewChange::off;
    if (view_taken && !force) return ViewChange::taken;
    asked.push_back((force ? "force view " : "view ") + std::to_string(job) + " " + std::to_string(output));
    now.viewer.file = found->outputs[output].path;
    return ViewChange::made;
  }
  std::optional<std::string> thumbnail_path(std::int64_t job, std::size_t output) override {
    const auto found = thumbnails.find({job, output});
    return found == thumbnails.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  static bool is_problem(const JobView& job) {
    return job.state == JobState::failed || job.state == JobState::quarantined;
  }
  static bool has_text(const std::string& where, const std::string& text) {
    const auto same = [](char a, char b) { return std::tolower(a) == std::tolower(b); };
    return std::search(where.begin(), where.end(), text.begin(), text.end(), same) != where.end();
  }
  static bool matches(const JobView& job, const JobQuery& query) {
    if ((query.state && job.state != *query.state) || (query.watch && job.watch != *query.watch)) return false;
    if (!has_text(job.source, query.text) && !has_text(job.reason, query.text)) return false;
    return query.problem.empty() || (is_problem(job) && key_of(job) == query.problem);
  }
  static void sort(std::vector<JobView>& jobs, const JobOrder& order) {
    const auto less = [key = order.key](const JobView& a, const JobView& b) {
      switch (key) {
        case JobOrderKey::changed:
          return a.changed_at < b.changed_at;
        case JobOrderKey::discovered:
          return a.discovered_at < b.discovered_at;
        case JobOrderKey::source:
          return a.source < b.source;
        case JobOrderKey::state:
          return job_state_name(a.state) < job_state_name(b.state);
        case JobOrderKey::watch:
          return a.watch < b.watch;
        case JobOrderKey::bytes:
          return a.source_bytes < b.source_bytes;
        case JobOrderKey::seconds:
          break;
      }
      return a.seconds < b.seconds;
    };
    std::stable_sort(jobs.begin(), jobs.end(),
                     [&](const JobView& a, const JobView& b) { return order.descending ? less(b, a) : less(a, b); });
  }
  static std::string key_of(const JobView& job) { return problem_key(job.source, job.reason); }
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
