#include "format/process/group_memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string_view>

#include "format/base/kernel_table.h"
#include "format/base/text.h"

namespace weir {
namespace {

// The names of the files of one cgroup version.
struct GroupFiles {
  const char* limit;
  const char* used;
  const char* cache;   // keys of memory.stat
  const char* shared;  // part of the cache that cannot be dropped: files in memory
};
constexpr GroupFiles kVersion2{"memory.max", "memory.current", "file", "shmem"};
constexpr GroupFiles kVersion1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_cache", "total_shmem"};

// Lowers `room` by the limits of the group at `group` below `root` and of the groups around it. In a container that
// sees its own group as the root, the kernel's path may lie outside; then only the root exists.
void look_upwards(const std::string& root, std::string group, const GroupFiles& files, std::uint64_t& room) {
  while (true) {
    const std::string directory = root + group + "/";
    const auto limit = number_in_file(directory + files.limit);
    const auto used = number_in_file(directory + files.used);
    if (limit && used) {
      const std::uint64_t files_in_memory = number_in_table(directory + "memory.stat", files.shared);
      const std::uint64_t all = std::min(*used, number_in_table(directory + "memory.stat", files.cache));
      const std::uint64_t cache = all - std::min(all, files_in_memory);
      room = std::min(room, *limit - std::min(*limit, *used - cache));
    }
    if (group.empty()) return;
    group.erase(group.rfind('/'));
  }
}

}  // namespace

std::uint64_t group_room(const std::string& groups, const std::string& mounts) {
  std::uint64_t room = std::numeric_limits<std::uint64_t>::max();
  std::ifstream lines(groups);
  for (std::string line; std::getline(lines, line);) {  // hierarchy:controllers:path
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos || second + 1 >= line.size() || line[second + 1] != '/') continue;
    const std::string_view controllers = std::string_view(line).substr(first + 1, second - first - 1);
    const std::string path = line.size() == second + 2 ? "" : line.substr(second + 1);
    if (controllers.empty()) {
      look_upwards(mounts, path, kVersion2, room);
    } else if (const auto names = split(controllers, ',');
               std::find(names.begin(), names.end(), "memory") != names.end()) {
      look_upwards(mounts + "/memory", path, kVersion1, room);
    }
  }
  return room;
}

}  // namespace weir
