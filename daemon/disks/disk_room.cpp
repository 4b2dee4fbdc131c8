#include "daemon/disks/disk_room.h"

#include <sys/stat.h>
#include <sys/statvfs.h>

#include <filesystem>

namespace weir {

DiskRoom room_in(const std::string& directory) {
  for (std::filesystem::path at = directory;; at = at.parent_path()) {
    struct statvfs status {};
    struct stat place {};
    if (::statvfs(at.c_str(), &status) == 0 && ::stat(at.c_str(), &place) == 0) {
      return {static_cast<std::uint64_t>(place.st_dev), static_cast<std::uint64_t>(status.f_bavail) * status.f_frsize,
              static_cast<std::uint64_t>(status.f_blocks) * status.f_frsize};
    }
    if (at == at.parent_path()) return {};
  }
}

}  // namespace weir
