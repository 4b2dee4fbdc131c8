// How a grid came to the device, and how long each stage took.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace weir {

/// The ways from a file to the device. load_paths (gpu/cuda/grid_loader.h) says which is fastest on a machine.
enum class LoadPath {
  registered,      ///< the mapping's own pages, page-locked chunk by chunk while earlier chunks copy
  pinned_ring,     ///< page-locked buffers filled by parallel preads
  direct_storage,  ///< from the disk without host memory: GPUDirect Storage, by cuFile
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

/// Seconds of each stage. The stages run at the same time. A stage on several threads adds up their seconds. A stage
/// that the path does not have stays 0.
struct LoadStages {
  double populate_s = 0;    ///< reading and mapping pages, or reading the file
  double register_s = 0;    ///< page-locking
  double copy_wait_s = 0;   ///< waiting for the next locked chunk (registered) or for a free buffer (pinned_ring)
  double drain_s = 0;       ///< from the last copy's start until all is copied and given back; pageable: all copies
  double unregister_s = 0;  ///< unlocking pages
};

struct LoadReport {
  LoadPath path = LoadPath::registered;
  bool zero_copy = false;   ///< the grid stays in host memory: see LoadOptions::zero_copy
  std::uint64_t bytes = 0;  ///< size of the grid without its padding
  double seconds = 0;       ///< from the call until the last byte is there
  LoadStages stages;
  std::string note;  ///< why faster ways were refused; empty if none was

  double gb_per_s() const { return seconds > 0 ? static_cast<double>(bytes) / seconds / 1e9 : 0; }
};

}  // namespace weir
