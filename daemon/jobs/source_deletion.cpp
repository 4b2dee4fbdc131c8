#include "daemon/jobs/source_deletion.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "daemon/config/watch_conflicts.h"
#include "daemon/disks/away_disk.h"
#include "daemon/jobs/conversion_task.h"
#include "daemon/jobs/outputs_fault.h"
#include "daemon/store/file_identity.h"
#include "daemon/watch/path_filter.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/descriptor.h"
#include "format/sidecar/sidecar.h"
#include "ingest/files/file_state.h"
#include "ingest/files/input_directory.h"

namespace weir {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

// Sources per turn of the event loop, which serves others, too: file systems may be slow.
constexpr int kLooks = 4;
constexpr std::size_t kTakenUp = 100;
// Delay before a source in use is looked at again.
constexpr milliseconds kAgain{10'000};
constexpr milliseconds kSoon{200};  // if delete_after is shorter than kAgain

constexpr const char* kInUse = "a program has it open for writing";
constexpr const char* kNotKnown =
    "whether a program writes to it cannot be known here; use complete = \"rename\" or \"marker\", or run the service "
    "as its owner";

milliseconds delay_of(const WatchConfig& watch) {
  return milliseconds(static_cast<std::int64_t>(watch.delete_after_s * 1000));
}

// Throws Error(io).
void flush_file(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file || ::fsync(file.get()) != 0) throw io_error(path, "flush it", errno);
}

// Returns whether `path` is a symbolic link: identify() looks at its target, a rename or removal acts on the link.
bool is_symbolic_link(const std::string& path) {
  std::error_code ignored;
  return fs::is_symlink(path, ignored);
}

// Returns whether `path` itself, not the target of a link, is the source of `job`.
bool is_source_file(const std::string& path, const Job& job) {
  return !is_symbolic_link(path) && identify(path) == job.identity;
}

std::string left_fault(const std::string& hidden, bool is_source) {
  return cat(hidden, is_source ? " is the source" : " is another file",
             ", which a deletion that was interrupted has left; give it a name");
}

}  // namespace

SourceDeletion::SourceDeletion(boost::asio::io_context& io, const JobStore& store, const EventLog& log, Held held,
                               std::unique_ptr<FileSystem> files)
    : store_(store), log_(log), held_(std::move(held)), files_(std::move(files)), timer_(io) {}

void SourceDeletion::configure(const DaemonConfig& config) {
  const std::vector<WatchConfig> before = std::exchange(watches_, {});
  waits_for_.clear();
  away_.clear();
  markers_.clear();
  for (const WatchConfig& watch : config.watches) {
    if (watch.complete == Completion::marker) markers_[watch.label] = watch.marker;
    if (watch.source == AfterDone::delete_after_verify) watches_.push_back(watch);
  }
  std::erase_if(due_, [&](const auto& entry) {
    const WatchConfig* now = deleting_watch(entry.second.watch);
    return now == nullptr || std::ranges::none_of(before, [&](const WatchConfig& watch) {
             return watch.label == now->label && watch.delete_after_s == now->delete_after_s;
           });
  });
  taking_up_ = !watches_.empty();
  taken_up_ = 0;
  hidden_.look_through(config.watches);
  arm();
}

void SourceDeletion::done(std::int64_t id) {
  const auto job = store_.job(id);
  const WatchConfig* watch = job ? deleting_watch(job->watch) : nullptr;
  if (watch == nullptr) return;
  due_[id] = {Clock::now() + delay_of(*watch), watch->label};
  arm();
}

const WatchConfig* SourceDeletion::deleting_watch(const std::string& label) const {
  const auto at =
      std::find_if(watches_.begin(), watches_.end(), [&](const WatchConfig& watch) { return watch.label == label; });
  return at == watches_.end() ? nullptr : &*at;
}

void SourceDeletion::arm() {
  if (idle() && hidden_.idle()) {
    timer_.cancel();
    return;
  }
  auto next = Clock::now();
  if (!taking_up_ && hidden_.idle()) {
    next = std::min_element(due_.begin(), due_.end(), [](const auto& a, const auto& b) {
             return a.second.time < b.second.time;
           })->second.time;
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
  if (held_ && held_()) {
    wait_until(Clock::now() + kAgain);
    return;
  }
  try {
    if (taking_up_) {
      take_up();
    } else if (!hidden_.idle()) {
      for (const HiddenSource& hidden : hidden_.step()) uncover(hidden);
    } else {
      look();
    }
    arm();
  } catch (const CorruptDatabase&) {
    throw;
  } catch (const Error& error) {  // a fault of the state file, which other parts log, too
    log_.warn("not-deleted", {{"reason", error.what()}});
    wait_until(Clock::now() + kAgain);
  }
}

void SourceDeletion::take_up() {
  const std::vector<Job> jobs = store_.over_since(0, taken_up_, kTakenUp);
  for (const Job& job : jobs) {
    taken_up_ = job.id;
    const WatchConfig* watch = job.state == JobState::done ? deleting_watch(job.watch) : nullptr;
    if (watch != nullptr) due_.try_emplace(job.id, Due{Clock::now() + delay_of(*watch), watch->label});
  }
  taking_up_ = jobs.size() == kTakenUp;
}

void SourceDeletion::look() {
  const Clock::time_point now = Clock::now();
  std::map<std::string, bool> waits;  // by label, of watches with sources that are due
  int looks = 0;
  for (auto at = due_.begin(); at != due_.end() && looks < kLooks;) {
    if (at->second.time > now) {
      ++at;
      continue;
    }
    const WatchConfig* watch = deleting_watch(at->second.watch);
    if (watch != nullptr && !waits.contains(watch->label)) waits[watch->label] = waits_for_disks(*watch);
    bool later = watch != nullptr && waits[watch->label];
    if (!later) {
      ++looks;
      const auto job = store_.job(at->first);
      const bool here = watch != nullptr && job && job->state == JobState::done;  // otherwise it is converted anew
      later = here && try_to_delete(*job, *watch) == Outcome::later;
    }
    if (later) {
      at->second.time = now + std::clamp(delay_of(*watch), kSoon, kAgain);
      ++at;
      continue;
    }
    waits_for_.erase(at->first);
    named_back_.erase(at->first);
    at = due_.erase(at);
  }
}

// Returns whether sources or outputs of the watch cannot be judged now (away_disk.h). Logged once.
bool SourceDeletion::waits_for_disks(const WatchConfig& watch) {
  const std::string reason = away_disk(watch);
  if (reason.empty()) {
    away_.erase(watch.label);
  } else if (away_.insert(watch.label).second) {
    log_.warn("not-deleted", {{"watch", watch.label}, {"reason", reason}});
  }
  return !reason.empty();
}

// A source that cannot be looked at holds up no others. What a file system refuses is tried again later.
SourceDeletion::Outcome SourceDeletion::try_to_delete(const Job& job, const WatchConfig& watch) {
  try {
    return look_at(job, watch);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::io) return wait_for(job, error.what());
    keep(job, error.what());
    return Outcome::over;
  }
}

SourceDeletion::Outcome SourceDeletion::look_at(const Job& job, const WatchConfig& watch) {
  if (files_->exists(hidden_name(job))) return finish_interrupted(job, watch);
  if (is_gone_from(watch.directory, job.source)) return Outcome::over;
  if (!takes_source(watch, job.source) || job.options != options_text(watch)) {
    keep(job, "the watch does not take it any more, or converts it otherwise");
    return Outcome::over;
  }
  if (is_head(job.source)) {
    keep(job, "it stands for a directory, whose files are never deleted");
    return Outcome::over;
  }
  if (is_symbolic_link(job.source)) {
    keep(job, "it is a symbolic link, whose target would stay");
    return Outcome::over;
  }
  const auto identity = identify(job.source);
  if (!identity) return Outcome::later;                 // for example, a server that does not answer
  if (*identity != job.identity) return Outcome::over;  // the watch sees this change, too
  if (const std::string fault = outputs_fault(job, state_since_certified(job)); !fault.empty()) {
    if (!away_disk(watch).empty()) return Outcome::later;
    keep(job, fault);
    return Outcome::over;
  }
  flush_outputs(job, watch);
  const FileWriters writers(job.source);
  if (writers.some()) return wait_for(job, kInUse);
  if (!writers.known() && !says_when_done(watch.complete)) {
    keep(job, kNotKnown);
    return Outcome::over;
  }
  return remove(job, writers);
}

// Flushes outputs and directories: a conversion flushes only its own directory, and nothing if the output was done.
void SourceDeletion::flush_outputs(const Job& job, const WatchConfig& watch) const {
  for (const JobOutput& output : job.result.outputs) {
    for (const std::string& path : {output.path, sidecar_path(output.path)}) flush_file(path);
    fs::path directory = fs::path(output.path).parent_path();
    for (; directory.has_relative_path() && is_within(directory.string(), watch.output);
         directory = directory.parent_path()) {
      files_->sync_directory(directory.string());
    }
  }
}

// Returns the source's state; none if only remove()'s own rename, after a check of the status, has changed it.
std::optional<FileState> SourceDeletion::state_since_certified(const Job& job) const {
  const FileState state = look_at_file(job.source);
  const auto back = named_back_.find(job.id);
  return back != named_back_.end() && back->second == state.ctime_ns ? std::nullopt : std::optional(state);
}

SourceDeletion::Outcome SourceDeletion::wait_for(const Job& job, const std::string& reason) {
  if (std::exchange(waits_for_[job.id], reason) != reason) keep(job, cat(reason, "; tried again later"));
  return Outcome::later;
}

void SourceDeletion::give_name_back(const Job& job) {
  files_->rename_new(hidden_name(job), job.source);
  named_back_[job.id] = look_at_file(job.source).ctime_ns;
}

// Renames the source to a hidden name first, which no watch accepts. A file that took the source's place gets its
// name back, and so does a source that a writer asked for (`writers`). After the rename no program can find it.
SourceDeletion::Outcome SourceDeletion::remove(const Job& job, const FileWriters& writers) {
  const std::string doomed = hidden_name(job);
  files_->rename_new(job.source, doomed);
  bool is_source = false;
  bool one_waits = false;
  try {
    is_source = is_source_file(doomed, job);
    one_waits = writers.one_waits();
  } catch (const Error&) {
    if (files_->exists(doomed)) give_name_back(job);
    throw;
  }
  if (is_source && !one_waits) return remove_hidden(job, writers.known());
  give_name_back(job);
  return one_waits ? wait_for(job, kInUse) : Outcome::over;
}

// Removes the marker first: left alone, it would call the next file of that name complete too early. A kill in
// between leaves the hidden name, and finish_interrupted() calls this function again.
SourceDeletion::Outcome SourceDeletion::remove_hidden(const Job& job, bool writers_known) {
  const std::string doomed = hidden_name(job);
  const std::string marker = marker_of(job);
  // Equal times count, too: the marker of the source existed before its conversion.
  const auto is_of_next_file = [&] {
    return files_->exists(job.source) && look_at_file(marker).ctime_ns >= look_at_file(doomed).ctime_ns;
  };
  const bool has_marker = !marker.empty() && files_->exists(marker) && !is_of_next_file();
  try {
    if (has_marker) {
      files_->remove(marker);
      files_->sync_directory(fs::path(marker).parent_path().string());
    }
    files_->remove(doomed);
  } catch (const Error& error) {
    const bool marker_stays = has_marker && files_->exists(marker);
    if (files_->exists(doomed) && !files_->exists(job.source)) {
      give_name_back(job);
      if (has_marker && !marker_stays) mark_again(job);
    }
    if (!marker_stays) throw;
    const std::string reason = error.what();
    if (std::exchange(waits_for_[job.id], reason) != reason) {
      log_.warn("marker-stays", {{"job", job.id}, {"reason", cat(reason, "; its source stays, tried again later")}});
    }
    return Outcome::later;
  }
  log_.info("deleted", {{"job", job.id}, {"source", job.source}, {"in_use", writers_known ? "no" : "not known"}});
  return Outcome::over;
}

std::string SourceDeletion::marker_of(const Job& job) const {
  const auto at = markers_.find(job.watch);
  return at == markers_.end() ? std::string() : job.source + at->second;
}

// Without its marker, the watch would not accept the source that has its name back.
void SourceDeletion::mark_again(const Job& job) const {
  const std::string marker = marker_of(job);
  if (marker.empty() || files_->exists(marker)) return;
  try {
    files_->create(marker);
  } catch (const Error& error) {
    keep(job, cat("its marker was removed and could not be made again: ", error.what()));
  }
}

// Finishes an interrupted deletion. All conditions held when the source was renamed, which changed its status.
SourceDeletion::Outcome SourceDeletion::finish_interrupted(const Job& job, const WatchConfig& watch) {
  const std::string doomed = hidden_name(job);
  const bool is_source = is_source_file(doomed, job);
  const FileWriters writers(doomed);
  if (is_source && writers.some()) return wait_for(job, kInUse);  // opened before it was hidden
  std::string fault = is_source ? outputs_fault(job, std::nullopt) : "";
  if (is_source && fault.empty() && !writers.known() && !says_when_done(watch.complete)) fault = kNotKnown;
  if (is_source && fault.empty()) {
    flush_outputs(job, watch);
    return remove_hidden(job, writers.known());
  }
  if (files_->exists(job.source)) {
    keep(job, left_fault(doomed, is_source));
  } else {
    files_->rename_new(doomed, job.source);
    if (is_source) {
      mark_again(job);
      keep(job, cat(fault, "; let its job be done again (weir retry --force ", job.id, ")"));
    }
  }
  return Outcome::over;
}

// Handles a hidden source that is not to be deleted any more (finish_interrupted() handles the others): the source of
// its job gets its name back. Without a job, its former name is unknown.
void SourceDeletion::uncover(const HiddenSource& hidden) const {
  const auto job = store_.job(hidden.job);
  if (!job || hidden_name(*job) != hidden.path) {
    log_.warn("not-deleted", {{"source", hidden.path},
                              {"reason",
                               "a deletion that was interrupted has left a source under this name, and no job tells "
                               "its own; give it that, or remove it"}});
    return;
  }
  if (job->state == JobState::done && deleting_watch(job->watch) != nullptr) return;
  try {
    const bool is_source = identify(hidden.path) == job->identity;
    if (!is_source || files_->exists(job->source)) {
      keep(*job, left_fault(hidden.path, is_source));
      return;
    }
    files_->rename_new(hidden.path, job->source);
    mark_again(*job);
    keep(*job, cat("a deletion that was interrupted had left it as ", hidden.path,
                   "; it has its name back. To have it deleted, let its job be done again (weir retry --force ",
                   job->id, ")"));
  } catch (const Error& error) {
    keep(*job, error.what());
  }
}

void SourceDeletion::keep(const Job& job, const std::string& reason) const {
  log_.warn("not-deleted", {{"job", job.id}, {"source", job.source}, {"reason", reason}});
}

}  // namespace weir
