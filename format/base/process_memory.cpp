#include "format/base/process_memory.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

namespace weir {
namespace {

// The number behind `key` in one of the kernel's tables; 0 where there is none.
std::uint64_t number_in(const char* table, const std::string& key) {
  std::ifstream lines(table);
  std::string word;
  while (lines >> word) {
    if (word != key) continue;
    std::uint64_t number = 0;
    lines >> number;
    return number;
  }
  return 0;
}

// A file that holds one number; nullopt where it is missing or says "max".
std::optional<std::uint64_t> number_of(const char* path) {
  std::ifstream file(path);
  std::uint64_t number = 0;
  return file >> number ? std::optional(number) : std::nullopt;
}

}  // namespace

std::uint64_t resident_bytes() { return 1024 * number_in("/proc/self/status", "VmRSS:"); }

std::uint64_t peak_resident_bytes() { return 1024 * number_in("/proc/self/status", "VmHWM:"); }

std::uint64_t available_bytes() {
  const std::uint64_t system = 1024 * number_in("/proc/meminfo", "MemAvailable:");
  const auto limit = number_of("/sys/fs/cgroup/memory.max");
  const auto used = number_of("/sys/fs/cgroup/memory.current");
  if (!limit || !used) return system;
  const std::uint64_t taken = *used - std::min(*used, number_in("/sys/fs/cgroup/memory.stat", "file"));  // less caches
  return std::min(system, *limit - std::min(*limit, taken));
}

}  // namespace weir
