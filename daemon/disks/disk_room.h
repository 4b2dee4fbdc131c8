// The room on the file system that a directory lies on, or will lie on.
#pragma once

#include <cstdint>
#include <string>

namespace weir {

struct DiskRoom {
  std::uint64_t device = 0;  ///< tells file systems apart
  std::uint64_t free = 0;    ///< bytes
  std::uint64_t total = 0;
};

/// Of the nearest directory there is; all 0 where none can be asked.
DiskRoom room_in(const std::string& directory);

}  // namespace weir
