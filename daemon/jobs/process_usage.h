// What the daemon itself takes of the machine, as the kernel counts it, and what memory that has left.
#pragma once

#include <cstdint>

namespace weir {

struct ProcessUsage {
  std::uint64_t resident_bytes = 0;
  std::uint64_t open_descriptors = 0;
  std::uint64_t threads = 0;
};

/// Of this process, now (/proc/self).
ProcessUsage process_usage();

/// MemAvailable of /proc/meminfo in bytes; the largest number where the system does not say.
std::uint64_t available_memory();

}  // namespace weir
