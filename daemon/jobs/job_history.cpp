#include "daemon/jobs/job_history.h"

#include <vector>

#include "daemon/store/file_identity.h"
#include "format/base/error.h"

namespace weir {
namespace {

constexpr std::chrono::hours kLookInterval{24};
/// Jobs per piece. A piece is short even if each look waits for a file server, because others have their turn after
/// it.
constexpr std::size_t kPiece = 100;
constexpr std::chrono::milliseconds kBetweenPieces{10};
constexpr double kDay_ms = 86'400'000;

}  // namespace

JobHistory::JobHistory(boost::asio::io_context& io, DiskTurns& turns, JobStore& store, const EventLog& log)
    : turns_(turns), store_(store), log_(log), timer_(io) {}

void JobHistory::keep(double days, std::span<const WatchConfig> watches) {
  age_ms_ = static_cast<std::int64_t>(days * kDay_ms);
  directories_.clear();
  for (const WatchConfig& watch : watches) directories_[watch.label] = watch.directory;
  after(std::chrono::milliseconds(0), &JobHistory::look_through);
}

void JobHistory::after(std::chrono::milliseconds delay, void (JobHistory::*next)()) {
  timer_.expires_after(delay);
  timer_.async_wait([this, next](boost::system::error_code error) {
    if (!error) turns_.take([this, next] { (this->*next)(); });
  });
}

void JobHistory::look_through() {
  at_ = 0;
  forgotten_ = 0;
  step();
}

bool JobHistory::is_over(const Job& job) const {
  const auto directory = directories_.find(job.watch);
  return directory == directories_.end() ? is_gone(job.source) : is_gone_from(directory->second, job.source);
}

void JobHistory::step() {
  std::vector<Job> jobs;
  try {
    jobs = store_.over_since(age_ms_, at_, kPiece);
    store_.together([&] {
      for (const Job& job : jobs) forgotten_ += is_over(job) && store_.remove(job.id) ? 1 : 0;
    });
  } catch (const CorruptDatabase&) {
    throw;
  } catch (const Error&) {  // other parts report the fault; the next look, a day later, is early enough
    jobs.clear();
  }
  if (!jobs.empty()) {
    at_ = jobs.back().id;
    return after(kBetweenPieces, &JobHistory::step);
  }
  if (forgotten_ > 0) log_.info("history", {{"forgotten", forgotten_}});
  after(kLookInterval, &JobHistory::look_through);
}

}  // namespace weir
