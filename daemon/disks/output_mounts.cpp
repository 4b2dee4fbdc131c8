#include "daemon/disks/output_mounts.h"

#include <fcntl.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "format/base/text.h"

namespace weir {

void OutputMounts::watch(const std::vector<std::string>& paths) {
  const std::set<std::string> before = std::exchange(paths_, {paths.begin(), paths.end()});
  paths_.erase("");
  std::erase_if(missing_, [this](const std::string& path) { return !paths_.contains(path); });
  if (look()) return;
  std::ranges::copy_if(paths_, std::inserter(missing_, missing_.end()),
                       [&](const std::string& path) { return !before.contains(path); });
}

bool OutputMounts::look() {
  if (paths_.empty()) return true;
  const MountTable table = read_();
  if (table.empty()) return false;
  for (const std::string& path : paths_) {
    if (!table.mounted(path)) {
      if (!missing_.insert(path).second) continue;
      log_.error("output-not-mounted",
                 {{"mount", path}, {"reason", "jobs with outputs there wait until it is mounted"}});
    } else if (missing_.erase(path) > 0) {
      log_.info("output-mounted", {{"mount", path}});
    }
  }
  return true;
}

std::string OutputMounts::text() const {
  std::string text;
  for (const std::string& path : missing_) {
    text += cat(text.empty() ? "" : "; ", "no file system is mounted at ", path);
  }
  return text;
}

Descriptor hold_mount(const std::string& path) {
  return Descriptor(path.empty() ? -1 : ::open(path.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
}

}  // namespace weir
