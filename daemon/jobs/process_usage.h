// The resources that the daemon itself uses, as the kernel counts them.
#pragma once

#include <cstdint>

namespace weir {

struct ProcessUsage {
  std::uint64_t resident_bytes = 0;
  std::uint64_t open_descriptors = 0;
  std::uint64_t threads = 0;
};

/// Returns the present usage of this process (/proc/self).
ProcessUsage process_usage();

}  // namespace weir
