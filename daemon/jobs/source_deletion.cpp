#include "daemon/jobs/source_deletion.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "daemon/jobs/conversion_task.h"
#include "daemon/store/file_identity.h"
#include "daemon/watch/file_writers.h"
#include "daemon/watch/path_filter.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/sidecar/sidecar.h"
#include "ingest/files/file_state.h"
#include "ingest/files/input_directory.h"

namespace weir {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

// In one turn of the event loop, which has others to serve: file systems may be slow.
constexpr int kLooks = 4;
constexpr std::size_t kTakenUp = 100;
// Between two looks at a source that is in use.
constexpr milliseconds kAgain{10'000};
constexpr milliseconds kSoon{200};  // where delete_after is shorter than that

milliseconds delay_of(const WatchConfig& watch) {
  return milliseconds(static_cast<std::int64_t>(watch.delete_after_s * 1000));
}

// What of the values no error counts, where the output is called lossless or they are not even finite; empty: nothing.
std::string loss_fault(const nlohmann::json& sidecar, const std::string& path) {
  const auto member = [](const nlohmann::json& of, const char* key) {
    return of.is_object() ? of.value(key, nlohmann::json()) : nlohmann::json();
  };
  const nlohmann::json loss = member(sidecar, "conversion_loss");
  const auto count = [&](const char* key) {
    const nlohmann::json value = member(loss, key);
    return value.is_number_unsigned() ? value.get<std::uint64_t>() : 0;
  };
  const std::uint64_t overflow = count("overflow");
  if (overflow > 0)
    return cat(path, ": ", overflow, overflow == 1 ? " value is" : " values are", " infinite in float32");
  const std::uint64_t inexact = count("inexact");
  if (inexact == 0 || member(member(sidecar, "error"), "lossless") != true) return {};
  return cat(path, ": ", inexact, inexact == 1 ? " value was" : " values were",
             " rounded to float32, so the output is not lossless");
}

// Why the certificate is not that of the source as it is; empty: it is.
std::string certificate_fault(const Job& job, const std::string& path) {
  const FileState record = look_at_file(path);
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return cat(path, " is not there");
  std::ifstream file(path);
  const nlohmann::json sidecar = nlohmann::json::parse(file, nullptr, false);
  if (!sidecar.is_object() || !sidecar.contains("source") || !sidecar["source"].is_object()) {
    return cat(path, " cannot be read");
  }
  const nlohmann::json& source = sidecar["source"];
  if (source.contains("files_digest")) return "its values lie in several files, which other headers may name";
  const auto is = [&](const char* key, const nlohmann::json& value) {
    return source.contains(key) && source[key] == value;
  };
  if (!is("path", job.source) || !is("bytes", job.identity.bytes) || !is("mtime", utc_text(job.identity.mtime_ns)) ||
      touched_since(look_at_file(job.source), record)) {
    return cat(path, " is of another file, or of this one as it was before");
  }
  return loss_fault(sidecar, path);
}

std::string hidden_name(const Job& job) {
  return (fs::path(job.source).parent_path() / cat(".weir-delete-", job.id)).string();
}

// Why the outputs do not stand for the source; empty: they do.
std::string outputs_fault(const Job& job) {
  if (job.result.outputs.empty()) return "it has no outputs";
  for (const JobOutput& output : job.result.outputs) {
    std::error_code error;
    if (fs::file_size(output.path, error) != output.bytes || error) return cat(output.path, " is not there as it was");
    if (std::string fault = certificate_fault(job, sidecar_path(output.path)); !fault.empty()) return fault;
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
    if (watch.source == AfterDone::delete_after_verify) watches_.push_back(watch);
  }
  taking_up_ = !watches_.empty();
  taken_up_ = 0;
  arm();
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
  if (idle()) {
    timer_.cancel();
    return;
  }
  auto next = Clock::now();
  if (!taking_up_) {
    next = std::min_element(due_.begin(), due_.end(), [](const auto& a, const auto& b) {
             return a.second < b.second;
           })->second;
  }
  wait_until(next);
}

void SourceDeletion::wait_until(Clock::time_point time) {
  timer_.expires_at(time);
  timer_.async_wait([this](boost::system::error_code error) {
    if (!error) work();
  });
}

void SourceDeletion::work() {
  try {
    taking_up_ ? take_up() : look();
    arm();
  } catch (const CorruptDatabase&) {
    throw;
  } catch (const Error& error) {  // of the state file: others say so, too
    log_.warn("not-deleted", {{"reason", error.what()}});
    wait_until(Clock::now() + kAgain);
  }
}

void SourceDeletion::take_up() {
  const std::vector<Job> jobs = store_.over_since(0, taken_up_, kTakenUp);
  for (const Job& job : jobs) {
    taken_up_ = job.id;
    const WatchConfig* watch = job.state == JobState::done ? deleting_watch(job.watch) : nullptr;
    if (watch != nullptr) due_.try_emplace(job.id, Clock::now() + delay_of(*watch));
  }
  taking_up_ = jobs.size() == kTakenUp;
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
}

SourceDeletion::Outcome SourceDeletion::look_at(const Job& job, const WatchConfig& watch) {
  finish_interrupted(job, watch);
  if (is_gone(job.source)) return Outcome::over;
  if (!is_source_of(watch, job.source) || job.options != options_text(watch) ||
      !PathFilter(watch).accepts_file(job.source.substr(watch.directory.size() + 1))) {
    keep(job, "the watch does not take it any more, or converts it otherwise");
    return Outcome::over;
  }
  if (is_head(job.source)) {
    keep(job, "it stands for a directory, whose files are never deleted");
    return Outcome::over;
  }
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
  if (!writers.known() && !says_when_done(watch.complete)) {
    keep(job,
         "whether a program writes to it cannot be known here; use complete = \"rename\" or \"marker\", or run the "
         "service as its owner");
    return Outcome::over;
  }
  return remove(job, watch, writers.known());
}

// Under a hidden name first, which is never a source: what took its place meanwhile gets its name back.
SourceDeletion::Outcome SourceDeletion::remove(const Job& job, const WatchConfig& watch, bool writers_known) {
  const std::string doomed = hidden_name(job);
  try {
    files_->rename_new(job.source, doomed);
    if (identify(doomed) != job.identity) {
      files_->rename_new(doomed, job.source);
      return Outcome::over;
    }
    files_->remove(doomed);
  } catch (const Error& error) {
    if (files_->exists(doomed)) files_->rename_new(doomed, job.source);
    keep(job, error.what());
    return Outcome::over;
  }
  removed(job, watch, writers_known);
  return Outcome::over;
}

void SourceDeletion::removed(const Job& job, const WatchConfig& watch, bool writers_known) const {
  log_.info("deleted", {{"job", job.id}, {"source", job.source}, {"in_use", writers_known ? "no" : "not known"}});
  // A marker left behind would call the next file of that name complete before it is.
  if (watch.complete == Completion::marker) files_->remove(job.source + watch.marker);
}

// The source under its hidden name was to be deleted: all that must hold held. Its status has changed since.
void SourceDeletion::finish_interrupted(const Job& job, const WatchConfig& watch) const {
  const std::string doomed = hidden_name(job);
  if (!files_->exists(doomed)) return;
  try {
    if (identify(doomed) == job.identity) {
      files_->remove(doomed);
      removed(job, watch, true);
    } else if (!files_->exists(job.source)) {
      files_->rename_new(doomed, job.source);
    } else {
      keep(job, cat(doomed, " is another file, which a deletion that was interrupted has left; give it a name"));
    }
  } catch (const Error& error) {
    keep(job, error.what());
  }
}

void SourceDeletion::keep(const Job& job, const std::string& reason) const {
  log_.warn("not-deleted", {{"job", job.id}, {"source", job.source}, {"reason", reason}});
}

}  // namespace weir
