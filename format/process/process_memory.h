// The process's resident memory and the available memory, as the kernel counts them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace weir {

/// Returns the bytes that are resident now (VmRSS of /proc/self/status).
std::uint64_t resident_bytes();
/// Returns the most bytes that were ever resident (VmHWM). It counts this program only; getrusage would also count the
/// process that started it.
std::uint64_t peak_resident_bytes();

/// Returns the bytes that this process can still take: the system's MemAvailable, or what the limits of its control
/// groups leave (group_memory.h) if that is less. Returns the largest number if neither is known.
std::uint64_t available_bytes();

/// Has the system allocate the pages of `memory` that have none yet, so that several threads can do it before other
/// threads need the pages. The memory begins at a page and the caller may write to it; its bytes stay as they are. Does
/// nothing on a Linux before 5.14.
void make_pages(std::span<const std::byte> memory);

}  // namespace weir
