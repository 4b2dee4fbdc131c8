#include "format/process/process_memory.h"

#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <limits>

#include "format/base/kernel_table.h"
#include "format/process/group_memory.h"

namespace weir {

#ifndef MADV_POPULATE_WRITE
constexpr int MADV_POPULATE_WRITE = 23;  // Linux 5.14; unknown to older C libraries
#endif

std::uint64_t resident_bytes() { return 1024 * number_in_table("/proc/self/status", "VmRSS:"); }

std::uint64_t peak_resident_bytes() { return 1024 * number_in_table("/proc/self/status", "VmHWM:"); }

std::uint64_t available_bytes() {
  const std::uint64_t kibibytes = number_in_table("/proc/meminfo", "MemAvailable:");  // 0: not there
  const std::uint64_t system = kibibytes == 0 ? std::numeric_limits<std::uint64_t>::max() : 1024 * kibibytes;
  return std::min(system, group_room());
}

void make_pages(std::span<const std::byte> memory) {
  while (::madvise(const_cast<std::byte*>(memory.data()), memory.size(), MADV_POPULATE_WRITE) != 0) {
    if (errno != EINTR) return;  // the first access to a page allocates it then
  }
}

}  // namespace weir
