#include "daemon/disks/away_disk.h"

#include "format/base/text.h"
#include "format/io/is_directory.h"
#include "format/io/mount_table.h"

namespace weir {

std::string away_disk(const WatchConfig& watch) {
  if (!is_directory(watch.directory)) return cat(watch.directory, " is not there; tried again once it is");
  if (is_mounted(watch.output_mount)) return "";
  return cat("no file system is mounted at ", watch.output_mount, "; tried again once one is");
}

}  // namespace weir
