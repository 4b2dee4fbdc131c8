// The free space of the file system that a directory lies on, or will lie on.
#pragma once

#include <cstdint>
#include <string>

namespace weir {

struct DiskRoom {
  std::uint64_t device = 0;  ///< distinguishes file systems
  std::uint64_t free = 0;    ///< bytes
  std::uint64_t total = 0;
};

/// Returns the figures of the nearest existing directory at or above `directory`; all 0 if the system cannot tell.
DiskRoom room_in(const std::string& directory);

}  // namespace weir
