#include "daemon/jobs/scheduler.h"

#include <algorithm>
#include <tuple>

namespace weir {

std::optional<std::string> Scheduler::next(std::span<const WatchLoad> watches, std::uint64_t available_memory,
                                           Time now) const {
  if (paused_ || bandwidth_until(now)) return std::nullopt;
  int running = 0;
  for (const WatchLoad& watch : watches) running += watch.running;
  if (running >= limits_.jobs) return std::nullopt;
  if (running > 0 && available_memory < limits_.job_memory) return std::nullopt;
  const WatchLoad* best = nullptr;
  const auto rank = [&](const WatchLoad& watch) {
    const auto last = last_start_.find(watch.label);
    return std::tuple(watch.running, last == last_start_.end() ? 0 : last->second);
  };
  for (const WatchLoad& watch : watches) {
    if (watch.waiting && (best == nullptr || rank(watch) < rank(*best))) best = &watch;
  }
  if (best == nullptr) return std::nullopt;
  return best->label;
}

void Scheduler::started(const std::string& label) { last_start_[label] = ++starts_; }

void Scheduler::finished(std::uint64_t bytes, Time begin) {
  if (limits_.bandwidth == 0) return;
  const std::chrono::duration<double> due(static_cast<double>(bytes) / static_cast<double>(limits_.bandwidth));
  // Jobs that run at the same time share the cap, so the time of each job is added to the time of those before it.
  paid_until_ = std::max(paid_until_, begin) + std::chrono::duration_cast<Time::duration>(due);
}

std::optional<Scheduler::Time> Scheduler::bandwidth_until(Time now) const {
  if (limits_.bandwidth == 0 || paid_until_ <= now) return std::nullopt;
  return paid_until_;
}

}  // namespace weir
