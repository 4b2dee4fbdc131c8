// The sources that are known in a watched directory, and the reports of what
// changes: the part that inotify and polling share, and that one hands to the other.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/store/job.h"
#include "daemon/watch/directory_watch.h"
#include "daemon/watch/path_filter.h"

namespace weir {

/// Paths are relative to the watched directory. Markers are kept like sources and reported as their sources.
class SourceTable {
 public:
  SourceTable(const WatchConfig& watch, WatchListener listener);

  const WatchConfig& watch() const { return watch_; }
  const PathFilter& filter() const { return filter_; }
  /// Whether a file of this name is kept here.
  bool wants(std::string_view path) const;

  /// Whether the directory is there, as of the last look_at_root.
  bool up() const { return root_.has_value(); }
  enum class Root { missing, same, another };
  /// Looks whether the directory is there and is the one it was, and reports what changed. Of one that is back, or
  /// another one, the filter's paths are looked up anew, and the next look reports every file as found.
  Root look_at_root();

  /// Begins a look at everything; what neither saw() nor happened() names before end_look is looked for once more and
  /// then reported as removed. `events_tell`: files that events came of since the look before are left to
  /// events, as after end_look; else those from before begin_look are reported once more, for events may have been
  /// lost.
  void begin_look(bool events_tell);
  void end_look();
  /// A look shows that the file is there; reported as found where it was not known to be so.
  void saw(const std::string& path, const FileIdentity& identity);
  void overflowed();

  /// An event of the file: created, written, closed, moved_in, or permitted, which says nothing of its content.
  void happened(FileEventKind kind, const std::string& path);
  void removed(const std::string& path);
  void removed_below(const std::string& directory);

  /// One line for the log about `path`, once until settled(path).
  void complain(const std::string& path, const std::string& what);
  void settled(const std::string& path) { complaints_.erase(path); }

  std::size_t size() const { return known_.size(); }
  bool looked() const { return looked_; }  ///< whether a look at everything has ended
  std::uint64_t overflows() const { return overflows_; }
  std::string absolute(std::string_view path) const;

 private:
  struct Known {
    std::optional<FileIdentity> identity;  ///< as the last look showed it; none: events came since
    std::uint64_t look = 0;                ///< the last one that knew of it
  };
  using Place = std::map<std::string, Known>::iterator;

  void report(FileEventKind kind, const std::string& path);
  Place forget(Place place);

  WatchConfig watch_;
  WatchListener listener_;
  PathFilter filter_;
  std::optional<std::pair<dev_t, ino_t>> root_;
  bool root_looked_at_ = false;
  std::map<std::string, Known> known_;
  std::set<std::string> complaints_;
  std::uint64_t look_ = 0;
  bool events_tell_ = false;
  bool looked_ = false;
  std::uint64_t overflows_ = 0;
};

}  // namespace weir
