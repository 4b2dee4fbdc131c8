// The mounted file systems, as the kernel lists them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weir {

class MountTable {
 public:
  /// Reads /proc/self/mountinfo, which asks no file server. The table is empty if that file cannot be read.
  static MountTable read();
  /// Takes the lines of proc_pid_mountinfo(5). Lines that it cannot read are left out.
  explicit MountTable(std::string_view lines);

  bool empty() const { return mounts_.empty(); }
  /// Returns whether a file system is mounted at `path`, an absolute path; symbolic links are followed. A bind mount of
  /// another directory counts. A mount that shows the directory it covers does not: systemd makes such mounts for
  /// ReadWritePaths=. A mount point of autofs counts once the file system itself is mounted.
  bool mounted(const std::string& path) const;

 private:
  struct Mount {
    int id = 0;
    int parent = 0;
    std::string device;  ///< "major:minor"
    std::string root;    ///< the directory of the file system that is mounted
    std::string point;   ///< where it is mounted
    std::string type;    ///< of the file system
  };

  const Mount* find(int id) const;
  const Mount* topmost_at(const std::string& point) const;
  bool shows_what_it_covers(const Mount& mount) const;

  std::vector<Mount> mounts_;
};

/// Returns whether a file system is mounted at `path` now; see MountTable::mounted(). True for an empty path, which
/// asks for no mount.
bool is_mounted(const std::string& path);

}  // namespace weir
