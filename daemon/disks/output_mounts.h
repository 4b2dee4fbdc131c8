// The mount points that `output_mount` of the watches names. While no file system is mounted at one, the jobs of its
// watches wait, so that nothing is written to the directory below the mount point. Lives on one thread.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "daemon/log/event_log.h"
#include "format/io/is_mount_point.h"

namespace weir {

class OutputMounts {
 public:
  using IsMountPoint = std::function<bool(const std::string& path)>;

  /// `log` must outlive the object. Tests give `is_mount_point`.
  explicit OutputMounts(const EventLog& log, IsMountPoint is_mount_point = weir::is_mount_point)
      : log_(log), is_mount_point_(std::move(is_mount_point)) {}

  /// Looks now whether a file system is mounted at `path`, and logs a change. Returns true for an empty path.
  bool mounted(const std::string& path);
  /// Looks again at the mount points at which no file system was mounted.
  void look();
  /// Forgets all mount points but these.
  void keep(const std::vector<std::string>& paths);
  /// Returns whether all the mount points that were looked at are in use.
  bool all_mounted() const { return missing_.empty(); }
  /// Returns "no file system is mounted at PATH", joined by "; " for several; empty if all_mounted().
  std::string text() const;

 private:
  const EventLog& log_;
  IsMountPoint is_mount_point_;
  std::set<std::string> missing_;
};

}  // namespace weir
