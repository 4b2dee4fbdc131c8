// What the daemon itself takes of the machine, as the kernel counts it.
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

}  // namespace weir
