// The process's resident memory, and what is left, as the kernel counts it.
#pragma once

#include <cstdint>

namespace weir {

/// Bytes resident now (VmRSS of /proc/self/status).
std::uint64_t resident_bytes();
/// The most that were ever resident (VmHWM): of this program only, where getrusage also counts the
/// process that started it.
std::uint64_t peak_resident_bytes();

/// Bytes that this process can still take: the system's MemAvailable, or what the limits of its control groups leave
/// (group_memory.h) where that is less; the largest number where neither says any.
std::uint64_t available_bytes();

}  // namespace weir
