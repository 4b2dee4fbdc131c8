// The time of a file as one number.
#pragma once

#include <cstdint>
#include <limits>

namespace weir {

/// Returns the nanoseconds since 1970 for a file system's seconds and nanoseconds. A time before 1678 or after 2261
/// becomes the nearest that 64 bits hold.
inline std::int64_t nanoseconds_of(std::int64_t seconds, std::int64_t nanoseconds) {
  std::int64_t total = 0;
  if (!__builtin_mul_overflow(seconds, std::int64_t{1'000'000'000}, &total) &&
      !__builtin_add_overflow(total, nanoseconds, &total)) {
    return total;
  }
  return seconds < 0 ? std::numeric_limits<std::int64_t>::min() : std::numeric_limits<std::int64_t>::max();
}

}  // namespace weir
