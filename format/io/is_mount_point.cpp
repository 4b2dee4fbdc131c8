#include "format/io/is_mount_point.h"

#include <fcntl.h>
#include <linux/stat.h>
#include <sys/stat.h>

namespace weir {
namespace {

// For kernels that do not report mount points. The root directory is its own parent.
bool differs_from_parent(const std::string& path) {
  struct stat here {};
  struct stat above {};
  if (::stat(path.c_str(), &here) != 0 || ::stat((path + "/..").c_str(), &above) != 0) return false;
  return here.st_dev != above.st_dev || here.st_ino == above.st_ino;
}

}  // namespace

bool is_mount_point(const std::string& path) {
  struct statx status {};
  if (::statx(AT_FDCWD, path.c_str(), 0, STATX_TYPE, &status) != 0) return false;
  if ((status.stx_attributes_mask & STATX_ATTR_MOUNT_ROOT) == 0) return differs_from_parent(path);
  return (status.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0;
}

}  // namespace weir
