// How a grid came to the device, and how long each stage took.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace weir {

/// The ways from a file to the device; load_paths (gpu/cuda/grid_loader.h) says which is the fastest where.
enum class LoadPath {
  registered,      ///< the mapping's own pages, page-locked chunk by chunk while the chunk before copies
  pinned_ring,     ///< page-locked buffers filled by parallel preads
  direct_storage,  ///< from the disk past host memory: GPUDirect Storage, by cuFile
  pageable         ///< pread into ordinary memory, then a plain copy
};

/// "registered", "pinned-ring", "direct-storage", "pageable".
constexpr std::string_view load_path_name(LoadPath path) {
  switch (path) {
    case LoadPath::registered:
      return "registered";
    case LoadPath::pinned_ring:
      return "pinned-ring";
    case LoadPath::direct_storage:
      return "direct-storage";
    case LoadPath::pageable:
      break;
  }
  return "pageable";
}

/// Seconds of each stage; stages run at the same time and the first, second and last on several threads, whose
/// seconds add up. Only what the path taken has.
struct LoadStages {
  double populate_s = 0;    ///< reading and mapping pages, or reading the file
  double register_s = 0;    ///< page-locking
  double copy_wait_s = 0;   ///< the device waited for the next piece
  double drain_s = 0;       ///< from the last copy's start until all was copied and given back
  double unregister_s = 0;  ///< unlocking
};

struct LoadReport {
  LoadPath path = LoadPath::registered;
  bool zero_copy = false;   ///< the grid stays in host memory: see LoadOptions::zero_copy
  std::uint64_t bytes = 0;  ///< of the grid, without its padding
  double seconds = 0;       ///< for all, from the call to the last byte there
  LoadStages stages;
  std::string note;  ///< why faster ways were refused, "" where none was

  double gb_per_s() const { return seconds > 0 ? static_cast<double>(bytes) / seconds / 1e9 : 0; }
};

}  // namespace weir
