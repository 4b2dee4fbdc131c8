#include "daemon/disks/output_mounts.h"

#include <algorithm>

#include "format/base/text.h"

namespace weir {

bool OutputMounts::mounted(const std::string& path) {
  if (path.empty()) return true;
  if (is_mount_point_(path)) {
    if (missing_.erase(path) > 0) log_.info("output-mounted", {{"mount", path}});
    return true;
  }
  if (missing_.insert(path).second) {
    log_.error("output-not-mounted", {{"mount", path}, {"reason", "the jobs of its watches wait until it is mounted"}});
  }
  return false;
}

void OutputMounts::look() {
  const std::set<std::string> before = missing_;
  for (const std::string& path : before) mounted(path);
}

void OutputMounts::keep(const std::vector<std::string>& paths) {
  std::erase_if(missing_, [&](const std::string& path) { return std::ranges::find(paths, path) == paths.end(); });
}

std::string OutputMounts::text() const {
  std::string text;
  for (const std::string& path : missing_) {
    text += cat(text.empty() ? "" : "; ", "no file system is mounted at ", path);
  }
  return text;
}

}  // namespace weir
