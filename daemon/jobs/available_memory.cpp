#include "daemon/jobs/available_memory.h"

#include <fstream>
#include <limits>
#include <string>

namespace weir {

std::uint64_t available_memory() {
  std::ifstream info("/proc/meminfo");
  std::string line;
  while (std::getline(info, line)) {
    constexpr std::string_view kKey = "MemAvailable:";
    if (line.starts_with(kKey)) return std::stoull(line.substr(kKey.size())) * 1024;
  }
  return std::numeric_limits<std::uint64_t>::max();
}

}  // namespace weir
