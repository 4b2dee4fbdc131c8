// Memory that the system could give to a new process.
#pragma once

#include <cstdint>

namespace weir {

/// MemAvailable of /proc/meminfo in bytes; the largest number where the system does not say.
std::uint64_t available_memory();

}  // namespace weir
