#include "daemon/watch/source_table.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstdint>
#include <limits>
#include <utility>

#include "format/base/text.h"

namespace weir {
namespace {

// The identity of no real file.
constexpr FileIdentity kNoFile{std::numeric_limits<std::uint64_t>::max(), std::numeric_limits<std::int64_t>::min(), 0};

}  // namespace

SourceTable::SourceTable(const WatchConfig& watch, WatchListener listener)
    : watch_(watch), listener_(std::move(listener)), filter_(watch) {}

std::string SourceTable::absolute(std::string_view path) const {
  return path.empty() ? watch_.directory : cat(watch_.directory, '/', path);
}

bool SourceTable::wants(std::string_view path) const {
  return filter_.accepts_file(path) || filter_.marked_source(path).has_value();
}

void SourceTable::report(FileEventKind kind, const std::string& path) {
  const std::optional<std::string> source = filter_.marked_source(path);
  if (!source) return listener_.event({kind, absolute(path)});
  // A marker that goes away does not make its source incomplete.
  if (kind != FileEventKind::removed) listener_.event({FileEventKind::marked, absolute(*source)});
}

SourceTable::Root SourceTable::look_at_root() {
  struct stat status {};
  const bool there = ::stat(watch_.directory.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
  const auto before = root_;
  root_ = there ? std::optional(std::pair(status.st_dev, status.st_ino)) : std::nullopt;
  const bool first = !std::exchange(root_looked_at_, true);
  if (there && root_ == before) return Root::same;
  if (before || (first && !there)) listener_.event({FileEventKind::root_lost, watch_.directory});
  if (!there) return Root::missing;
  filter_ = PathFilter(watch_);
  if (first) return Root::another;
  listener_.event({FileEventKind::root_back, watch_.directory});
  // Every file is reported as found again, even if it is unchanged, because its job may have been forgotten.
  for (auto& [path, known] : known_) known.identity = kNoFile;
  return Root::another;
}

void SourceTable::begin_look(bool events_tell) {
  ++look_;
  events_tell_ = events_tell;
}

void SourceTable::end_look() {
  events_tell_ = true;
  looked_ = true;
  for (auto at = known_.begin(); at != known_.end();) {
    // A file that the look did not see may still be there: its directory could not be listed, or was renamed during
    // the look.
    struct stat status {};
    const bool gone = at->second.look != look_ && ::lstat(absolute(at->first).c_str(), &status) != 0 &&
                      (errno == ENOENT || errno == ENOTDIR);
    at = gone ? forget(at) : std::next(at);
  }
  std::erase_if(complaints_, [&](const std::string& path) {
    struct stat status {};
    return ::lstat(absolute(path).c_str(), &status) != 0 && errno == ENOENT;
  });
}

void SourceTable::saw(const std::string& path, const FileIdentity& identity) {
  const auto [at, is_new] = known_.try_emplace(path);
  Known& known = at->second;
  const bool during_look = known.look == look_;
  known.look = look_;
  if (!is_new && !known.identity && (events_tell_ || during_look)) {  // events have reported the file already
    // A later change that no event reports is found by the next look.
    if (!during_look) known.identity = identity;
    return;
  }
  if (std::exchange(known.identity, identity) != identity) report(FileEventKind::found, path);
}

void SourceTable::overflowed() {
  ++overflows_;
  listener_.event({FileEventKind::overflow, watch_.directory});
}

void SourceTable::happened(FileEventKind kind, const std::string& path) {
  if (kind != FileEventKind::permitted) known_[path] = {std::nullopt, look_};
  report(kind, path);
}

SourceTable::Place SourceTable::forget(Place place) {
  const std::string path = place->first;
  const Place next = known_.erase(place);
  settled(path);
  report(FileEventKind::removed, path);
  return next;
}

void SourceTable::removed(const std::string& path) {
  settled(path);
  if (const auto at = known_.find(path); at != known_.end()) forget(at);
}

void SourceTable::removed_below(const std::string& directory) {
  const std::string begin = cat(directory, '/');
  for (auto at = known_.lower_bound(begin); at != known_.end() && at->first.starts_with(begin);) at = forget(at);
}

void SourceTable::complain(const std::string& path, const std::string& what) {
  if (complaints_.insert(path).second) listener_.notice(cat(absolute(path), ": ", what));
}

}  // namespace weir
