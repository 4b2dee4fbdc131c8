#include "daemon/jobs/hidden_sources.h"

#include <optional>
#include <string_view>
#include <system_error>

#include "format/base/text.h"
#include "format/io/is_directory.h"

namespace weir {
namespace {

constexpr std::string_view kHiddenBegin = ".weir-delete-";
constexpr int kHiddenEntriesPerStep = 256;

// Returns the job's number from a hidden name; none for any other name.
std::optional<std::int64_t> hidden_job(const std::string& name) {
  if (!name.starts_with(kHiddenBegin)) return std::nullopt;
  const std::string number = name.substr(kHiddenBegin.size());
  if (number.empty() || number.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  return parse_int(number);
}

}  // namespace

std::string hidden_name(const Job& job) {
  return (std::filesystem::path(job.source).parent_path() / cat(kHiddenBegin, job.id)).string();
}

void HiddenSources::look_through(const std::vector<WatchConfig>& watches) {
  for (const WatchConfig& watch : watches) {
    if (!is_directory(watch.directory)) continue;
    if (!looked_.insert({watch.directory, watch.recursive}).second) continue;
    waiting_.push_back({watch.directory, watches_.size()});
    watches_.push_back({watch, PathFilter(watch)});
  }
}

void HiddenSources::open_next() {
  const Waiting next = waiting_.front();
  waiting_.pop_front();
  watch_ = next.watch;
  std::error_code unreadable;  // the watch reports it
  at_ = std::filesystem::directory_iterator(next.directory, unreadable);
  if (unreadable) at_ = {};
}

void HiddenSources::next() {
  std::error_code unreadable;
  at_.increment(unreadable);
  if (unreadable) at_ = {};
}

void HiddenSources::enter(const std::filesystem::directory_entry& entry) {
  const std::string path = entry.path().string();
  std::error_code gone;
  const auto& [config, filter] = watches_[watch_];
  if (!config.recursive || entry.is_symlink(gone) || !entry.is_directory(gone)) return;
  const std::string relative = path.substr(config.directory.size() + 1);
  if (filter.enters_directory(relative)) waiting_.push_back({path, watch_});
}

std::vector<HiddenSource> HiddenSources::step() {
  std::vector<HiddenSource> found;
  for (int i = 0; i < kHiddenEntriesPerStep && !idle(); ++i) {
    if (at_ == std::filesystem::directory_iterator()) {
      open_next();
      continue;
    }
    if (const auto job = hidden_job(at_->path().filename().string())) {
      found.push_back({at_->path().string(), *job});
    } else {
      enter(*at_);
    }
    next();
  }
  return found;
}

}  // namespace weir
