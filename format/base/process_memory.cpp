#include "format/base/process_memory.h"

#include <algorithm>

#include "format/base/group_memory.h"
#include "format/base/kernel_table.h"

namespace weir {

std::uint64_t resident_bytes() { return 1024 * number_in_table("/proc/self/status", "VmRSS:"); }

std::uint64_t peak_resident_bytes() { return 1024 * number_in_table("/proc/self/status", "VmHWM:"); }

std::uint64_t available_bytes() {
  return std::min(1024 * number_in_table("/proc/meminfo", "MemAvailable:"), group_room());
}

}  // namespace weir
