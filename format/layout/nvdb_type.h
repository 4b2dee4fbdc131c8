// The grid types of NanoVDB that weir reads, and the grid classes that it writes.
#pragma once

#include <cstdint>

namespace weir {

/// NanoVDB's grid types that hold scalars a renderer can use; values as on disk.
enum class GridType : std::uint32_t { float32 = 1, fp4 = 13, fp8 = 14, fp16 = 15, fpn = 16 };

/// NanoVDB's grid classes that a grid of scalars can have; values as on disk. NanoVDB's validators accept them for all
/// of GridType; they accept a staggered grid, 3, for vectors only.
enum class GridClass : std::uint32_t { unknown = 0, level_set = 1, fog_volume = 2 };

/// Returns "float32", "fp4", "fp8", "fp16" or "fpn".
constexpr const char* grid_type_name(GridType type) {
  switch (type) {
    case GridType::float32:
      return "float32";
    case GridType::fp4:
      return "fp4";
    case GridType::fp8:
      return "fp8";
    case GridType::fp16:
      return "fp16";
    case GridType::fpn:
      return "fpn";
  }
  return "unknown";
}

}  // namespace weir
