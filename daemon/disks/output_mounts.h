// The mount points that `output_mount` of the watches names. While no file system is mounted at one, the jobs of its
// watches wait, so that nothing is written to the directory below the mount point. Lives on one thread.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "daemon/log/event_log.h"
#include "format/io/descriptor.h"
#include "format/io/mount_table.h"

namespace weir {

class OutputMounts {
 public:
  using ReadTable = std::function<MountTable()>;

  /// `log` must outlive the object. Tests give `read`.
  explicit OutputMounts(const EventLog& log, ReadTable read = MountTable::read) : log_(log), read_(std::move(read)) {}

  /// Watches these paths from now on, and looks at them. Empty ones are left out. If the mount table cannot be read,
  /// new paths count as not mounted.
  void watch(const std::vector<std::string>& paths);
  /// Looks at all paths again, and logs what changed. Asks no file server, unless a path is not mounted or leads
  /// through symbolic links: then the file systems on the way are asked. Returns false, and changes nothing, if the
  /// mount table cannot be read.
  bool look();
  /// Returns whether a file system was mounted at `path` at the last look. True for an empty path.
  bool mounted(const std::string& path) const { return !missing_.contains(path); }
  bool all_mounted() const { return missing_.empty(); }
  /// Returns "no file system is mounted at PATH", joined by "; " for several; empty if all_mounted().
  std::string text() const;

 private:
  const EventLog& log_;
  ReadTable read_;
  std::set<std::string> paths_;
  std::set<std::string> missing_;
};

/// Opens the mount point `path`. While the descriptor is open, the file system there cannot be unmounted (EBUSY),
/// except by `umount -l`. Returns none for an empty path, and if it cannot be opened.
Descriptor hold_mount(const std::string& path);

}  // namespace weir
