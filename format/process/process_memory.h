// The process's resident memory, and what is left, as the kernel counts it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace weir {

/// Bytes resident now (VmRSS of /proc/self/status).
std::uint64_t resident_bytes();
/// The most that were ever resident (VmHWM): of this program only, where getrusage also counts the
/// process that started it.
std::uint64_t peak_resident_bytes();

/// Bytes that this process can still take: the system's MemAvailable, or what the limits of its control groups leave
/// (group_memory.h) where that is less; the largest number where neither says any.
std::uint64_t available_bytes();

/// Gives memory its pages where it has none yet, so that several threads do it before others need them. The memory
/// begins at a page, and the caller may write to it; its bytes stay as they are. Does nothing on a Linux before 5.14.
void make_pages(std::span<const std::byte> memory);

}  // namespace weir
