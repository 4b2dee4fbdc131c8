// The known sources of a watched directory, and the reports of their changes. Inotify and polling share this part,
// and one passes it to the other.
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
  /// Returns whether files of this name are kept in the table.
  bool wants(std::string_view path) const;

  /// Returns whether the directory was there at the last look_at_root().
  bool up() const { return root_.has_value(); }
  enum class Root { missing, same, another };
  /// Looks whether the directory is there and is the same as before, and reports a change. If it is back or is
  /// another one, the filter's paths are resolved again, and the next look reports every file as found.
  Root look_at_root();

  /// Begins a look at everything. A file that neither saw() nor happened() names before end_look() is looked for once
  /// more, and reported as removed if it is gone. If `events_tell`, the look does not report files that had events
  /// since the last look; this also holds after end_look(). Otherwise events may have been lost: then the look
  /// reports files as found if their events came before begin_look().
  void begin_look(bool events_tell);
  void end_look();
  /// Records that a look found the file. Reports it as found if it was unknown or has changed.
  void saw(const std::string& path, const FileIdentity& identity);
  void overflowed();

  /// Records and reports an event of the file: created, written, closed, moved_in, or permitted, which says nothing
  /// of its content.
  void happened(FileEventKind kind, const std::string& path);
  void removed(const std::string& path);
  void removed_below(const std::string& directory);

  /// Sends one line about `path` to the log, once until settled(path).
  void complain(const std::string& path, const std::string& what);
  void settled(const std::string& path) { complaints_.erase(path); }

  std::size_t size() const { return known_.size(); }
  bool looked() const { return looked_; }  ///< whether a look at everything has ended
  std::uint64_t overflows() const { return overflows_; }
  std::string absolute(std::string_view path) const;

 private:
  struct Known {
    std::optional<FileIdentity> identity;  ///< as the last look showed it; none: events came since
    std::uint64_t look = 0;  ///< number of the last look, or of the look during the last event, that knew the file
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
