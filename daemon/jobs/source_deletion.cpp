#include "daemon/jobs/source_deletion.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "daemon/config/watch_conflicts.h"
#include "daemon/jobs/conversion_task.h"
#include "daemon/store/file_identity.h"
#include "daemon/watch/file_writers.h"
#include "daemon/watch/path_filter.h"
#include "format/base/error.h"
#include "format/base/scalar_type.h"
#include "format/base/text.h"
#include "format/io/descriptor.h"
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

// What the certificate `path` says; null where it cannot be read.
nlohmann::json read_certificate(const std::string& path) {
  std::ifstream file(path);
  nlohmann::json sidecar = nlohmann::json::parse(file, nullptr, false);
  const bool whole = sidecar.is_object() && sidecar.contains("source") && sidecar["source"].is_object();
  return whole ? std::move(sidecar) : nlohmann::json();
}

// Whether the certificate tells what the job found of that output: another volume of the same size has another one.
bool is_of_output(const nlohmann::json& sidecar, const JobOutput& output) {
  const auto is = [&](const char* place, const std::optional<double>& expected) {
    const nlohmann::json::json_pointer pointer(place);
    if (!expected || !std::isfinite(*expected) || !sidecar.contains(pointer)) return true;
    return sidecar[pointer] == *expected;
  };
  return is("/value_range/0", output.min) && is("/value_range/1", output.max) &&
         is("/error/max_abs", output.max_error) && is("/error/psnr_db", output.psnr_db);
}

// Why `sidecar`, at `path`, is not the certificate of the job's source, of which `state` is now; empty: it is.
std::string certificate_fault(const Job& job, const nlohmann::json& sidecar, const std::string& path,
                              const std::optional<FileState>& state) {
  const nlohmann::json& source = sidecar["source"];
  if (source.contains("files_digest")) return "its values lie in several files, which other headers may name";
  const auto is = [&](const char* key, const nlohmann::json& value) {
    return source.contains(key) && source[key] == value;
  };
  if (!is("path", job.source) || !is("bytes", job.identity.bytes) || !is("mtime", utc_text(job.identity.mtime_ns)) ||
      (state && touched_since(*state, look_at_file(path)))) {
    return cat(path, " is of another file, or of this one as it was before");
  }
  return loss_fault(sidecar, path);
}

// Voxels of the volume that was read.
std::uint64_t voxels_of(const nlohmann::json& source) {
  const nlohmann::json extent = source.value("extent", nlohmann::json());
  std::uint64_t voxels = extent.is_array() ? 1 : 0;
  for (const nlohmann::json& axis : extent) voxels *= axis.is_number_unsigned() ? axis.get<std::uint64_t>() : 0;
  return voxels;
}

// In the file; 0: not known. A raw file without its count has no more than its bytes.
std::uint64_t values_of(const nlohmann::json& source) {
  const auto number = [&](const char* key) {
    const nlohmann::json value = source.value(key, nlohmann::json());
    return value.is_number_unsigned() ? value.get<std::uint64_t>() : 0;
  };
  const nlohmann::json type = source.value("type", nlohmann::json());
  if (const std::uint64_t counted = number("values"); counted > 0) return counted;
  const auto scalar = type.is_string() ? parse_scalar(type.get<std::string>()) : std::nullopt;
  return scalar && source.value("format", nlohmann::json()) == "raw" ? number("bytes") / scalar_bytes(*scalar) : 0;
}

std::string hidden_name(const Job& job) {
  return (fs::path(job.source).parent_path() / cat(".weir-delete-", job.id)).string();
}

// Throws Error(io).
void flush_file(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file || ::fsync(file.get()) != 0) throw io_error(path, "flush it", errno);
}

// Why the outputs do not stand for the source, of which `state` is now; empty: they do. Without `state`, which a rename
// changes, the source may be older or younger than its certificate.
std::string outputs_fault(const Job& job, const std::optional<FileState>& state) {
  if (job.result.outputs.empty()) return "it has no outputs";
  std::uint64_t voxels = 0;  // of all outputs
  std::uint64_t values = 0;  // of the source
  for (const JobOutput& output : job.result.outputs) {
    std::error_code error;
    if (fs::file_size(output.path, error) != output.bytes || error) return cat(output.path, " is not there as it was");
    const std::string path = sidecar_path(output.path);
    if (!fs::is_regular_file(path, error)) return cat(path, " is not there");
    const nlohmann::json sidecar = read_certificate(path);
    if (sidecar.is_null()) return cat(path, " cannot be read");
    if (std::string fault = certificate_fault(job, sidecar, path, state); !fault.empty()) return fault;
    if (!is_of_output(sidecar, output)) return cat(path, " is of another volume than the job's");
    const std::uint64_t counted = values_of(sidecar["source"]);
    if (counted == 0) {
      return cat(path, " does not say what else the file holds; let its job be done again (weir retry --force ", job.id,
                 ")");
    }
    values = counted;
    voxels += voxels_of(sidecar["source"]);
  }
  if (voxels >= values) return {};
  return cat("its outputs have ", voxels, " of the ", values,
             " values in it, and what else it holds would go with it; keep sources, or write that to another file");
}

}  // namespace

SourceDeletion::SourceDeletion(boost::asio::io_context& io, const JobStore& store, const EventLog& log, Held held)
    : store_(store), log_(log), held_(std::move(held)), timer_(io) {}

void SourceDeletion::configure(const DaemonConfig& config) {
  const std::vector<WatchConfig> before = std::exchange(watches_, {});
  in_use_.clear();
  for (const WatchConfig& watch : config.watches) {
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
  if (idle()) {
    timer_.cancel();
    return;
  }
  auto next = Clock::now();
  if (!taking_up_) {
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
    if (watch != nullptr) due_.try_emplace(job.id, Due{Clock::now() + delay_of(*watch), watch->label});
  }
  taking_up_ = jobs.size() == kTakenUp;
}

void SourceDeletion::look() {
  const Clock::time_point now = Clock::now();
  int looks = 0;
  for (auto at = due_.begin(); at != due_.end() && looks < kLooks;) {
    if (at->second.time > now) {
      ++at;
      continue;
    }
    ++looks;
    const auto job = store_.job(at->first);
    const WatchConfig* watch = job ? deleting_watch(job->watch) : nullptr;
    const bool here = watch != nullptr && job->state == JobState::done;  // else it is converted anew
    if (here && try_to_delete(*job, *watch) == Outcome::later) {
      at->second.time = now + std::clamp(delay_of(*watch), kSoon, kAgain);
      ++at;
      continue;
    }
    in_use_.erase(at->first);
    at = due_.erase(at);
  }
}

// One that cannot be looked at keeps no other waiting.
SourceDeletion::Outcome SourceDeletion::try_to_delete(const Job& job, const WatchConfig& watch) {
  try {
    return look_at(job, watch);
  } catch (const Error& error) {
    keep(job, error.what());
    return Outcome::over;
  }
}

SourceDeletion::Outcome SourceDeletion::look_at(const Job& job, const WatchConfig& watch) {
  if (files_->exists(hidden_name(job))) return finish_interrupted(job, watch);
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
  if (const std::string fault = outputs_fault(job, look_at_file(job.source)); !fault.empty()) {
    keep(job, fault);
    return Outcome::over;
  }
  flush_outputs(job, watch);
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

// A conversion flushes its own directory: neither those that were made for it, nor anything where it found the output
// done.
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

// Under a hidden name first, which is never a source: what took its place meanwhile gets its name back.
SourceDeletion::Outcome SourceDeletion::remove(const Job& job, const WatchConfig& watch, bool writers_known) {
  const std::string doomed = hidden_name(job);
  files_->rename_new(job.source, doomed);
  try {
    if (identify(doomed) == job.identity) {
      files_->remove(doomed);
      removed(job, watch, writers_known);
    } else {
      files_->rename_new(doomed, job.source);
    }
  } catch (const Error& error) {
    if (files_->exists(doomed)) files_->rename_new(doomed, job.source);
    keep(job, error.what());
  }
  return Outcome::over;
}

void SourceDeletion::removed(const Job& job, const WatchConfig& watch, bool writers_known) const {
  log_.info("deleted", {{"job", job.id}, {"source", job.source}, {"in_use", writers_known ? "no" : "not known"}});
  if (watch.complete != Completion::marker) return;
  try {
    files_->remove(job.source + watch.marker);
  } catch (const Error& error) {  // it would call the next file of that name complete before it is
    log_.warn("marker-stays", {{"job", job.id}, {"reason", error.what()}});
  }
}

// The source under its hidden name was to be deleted: all that must hold held then. Its status has changed since.
SourceDeletion::Outcome SourceDeletion::finish_interrupted(const Job& job, const WatchConfig& watch) const {
  const std::string doomed = hidden_name(job);
  const bool is_source = identify(doomed) == job.identity;
  const std::string fault = is_source ? outputs_fault(job, std::nullopt) : "";
  if (is_source && fault.empty()) {
    flush_outputs(job, watch);
    files_->remove(doomed);
    removed(job, watch, true);
  } else if (files_->exists(job.source)) {
    keep(job, cat(doomed, is_source ? " is the source" : " is another file",
                  ", which a deletion that was interrupted has left; give it a name"));
  } else {
    files_->rename_new(doomed, job.source);
    if (is_source) keep(job, cat(fault, "; let its job be done again (weir retry --force ", job.id, ")"));
  }
  return Outcome::over;
}

void SourceDeletion::keep(const Job& job, const std::string& reason) const {
  log_.warn("not-deleted", {{"job", job.id}, {"source", job.source}, {"reason", reason}});
}

}  // namespace weir
