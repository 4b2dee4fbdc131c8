#include "daemon/source_deletion.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "daemon/file_identity.h"
#include "daemon/file_writers.h"
#include "format/sidecar.h"
#include "format/text.h"

namespace weir {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

// In one turn of the event loop, which has others to serve: file systems may be slow.
constexpr int kLooks = 50;
// Between two looks at a source that is in use.
constexpr milliseconds kAgain{10'000};
constexpr milliseconds kSoon{200};  // where delete_after is shorter than that

milliseconds delay_of(const WatchConfig& watch) {
  return milliseconds(static_cast<std::int64_t>(watch.delete_after_s * 1000));
}

// Why the outputs do not stand for the source; empty: they do.
std::string outputs_fault(const Job& job) {
  if (job.result.outputs.empty()) return "it has no outputs";
  for (const JobOutput& output : job.result.outputs) {
    std::error_code error;
    if (fs::file_size(output.path, error) != output.bytes || error) return cat(output.path, " is not there as it was");
    std::ifstream file(sidecar_path(output.path));
    const nlohmann::json sidecar = nlohmann::json::parse(file, nullptr, false);
    if (!sidecar.is_object() || !sidecar.contains("source") || !sidecar["source"].is_object()) {
      return cat(sidecar_path(output.path), " cannot be read");
    }
    if (sidecar["source"].contains("files_digest")) {
      return "its values lie in several files, which other headers may name";
    }
  }
  return {};
}

}  // namespace

SourceDeletion::SourceDeletion(boost::asio::io_context& io, const JobStore& store, const EventLog& log)
    : store_(store), log_(log), timer_(io) {}

void SourceDeletion::configure(const DaemonConfig& config) {
  watches_.clear();
  due_.clear();
  in_use_.clear();
  for (const WatchConfig& watch : config.watches) {
    if (watch.source != AfterDone::delete_after_verify) continue;
    watches_.push_back(watch);
    take_up(watch);
  }
  arm();
}

void SourceDeletion::take_up(const WatchConfig& watch) {
  constexpr std::size_t kPage = 1000;
  const std::int64_t now = JobStore::wall_clock_ms();
  const std::int64_t delay = delay_of(watch).count();
  for (std::size_t offset = 0;; offset += kPage) {
    const std::vector<Job> page = store_.jobs({JobState::done, watch.label, ""}, offset, kPage);
    for (const Job& job : page) {
      // A clock that was set back must not hold it for longer than was asked.
      const std::int64_t left = std::clamp<std::int64_t>(job.finished_ms + delay - now, 0, delay);
      due_[job.id] = Clock::now() + milliseconds(left);
    }
    if (page.size() < kPage) return;
  }
}

void SourceDeletion::done(std::int64_t id) {
  const auto job = store_.job(id);
  const WatchConfig* watch = job ? deleting_watch(job->watch) : nullptr;
  if (watch == nullptr) return;
  due_[id] = Clock::now() + delay_of(*watch);
  arm();
}

const WatchConfig* SourceDeletion::deleting_watch(const std::string& label) const {
  const auto at =
      std::find_if(watches_.begin(), watches_.end(), [&](const WatchConfig& watch) { return watch.label == label; });
  return at == watches_.end() ? nullptr : &*at;
}

void SourceDeletion::arm() {
  if (due_.empty()) {
    timer_.cancel();
    return;
  }
  const auto next =
      std::min_element(due_.begin(), due_.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  timer_.expires_at(next->second);
  timer_.async_wait([this](boost::system::error_code error) {
    if (!error) look();
  });
}

void SourceDeletion::look() {
  const Clock::time_point now = Clock::now();
  int looks = 0;
  for (auto at = due_.begin(); at != due_.end() && looks < kLooks;) {
    if (at->second > now) {
      ++at;
      continue;
    }
    ++looks;
    const auto job = store_.job(at->first);
    const WatchConfig* watch = job ? deleting_watch(job->watch) : nullptr;
    const bool here = watch != nullptr && job->state == JobState::done;  // else it is converted anew
    if (here && look_at(*job, *watch) == Outcome::later) {
      at->second = now + std::clamp(delay_of(*watch), kSoon, kAgain);
      ++at;
      continue;
    }
    in_use_.erase(at->first);
    at = due_.erase(at);
  }
  arm();
}

SourceDeletion::Outcome SourceDeletion::look_at(const Job& job, const WatchConfig& watch) {
  if (is_gone(job.source)) return Outcome::over;
  const auto identity = identify(job.source);
  if (!identity) return Outcome::later;                 // a server that does not answer
  if (*identity != job.identity) return Outcome::over;  // the watch sees that, too
  if (const std::string fault = outputs_fault(job); !fault.empty()) {
    keep(job, fault);
    return Outcome::over;
  }
  const FileWriters writers(job.source);
  if (writers.some()) {
    if (in_use_.insert(job.id).second) keep(job, "a program has it open for writing; tried again later");
    return Outcome::later;
  }
  if (identify(job.source) != job.identity) return Outcome::over;
  std::error_code error;
  fs::remove(job.source, error);
  if (error) {
    keep(job, error.message());
    return Outcome::over;
  }
  log_.info("deleted", {{"job", job.id}, {"source", job.source}, {"in_use", writers.known() ? "no" : "not known"}});
  // A marker left behind would call the next file of that name complete before it is.
  if (watch.complete == Completion::marker) fs::remove(job.source + watch.marker, error);
  return Outcome::over;
}

void SourceDeletion::keep(const Job& job, const std::string& reason) const {
  log_.warn("not-deleted", {{"job", job.id}, {"source", job.source}, {"reason", reason}});
}

}  // namespace weir
