// The grid types of NanoVDB that weir reads.
#pragma once

#include <cstdint>

namespace weir {

/// NanoVDB's grid types that hold scalars a renderer can use; values as on disk.
enum class GridType : std::uint32_t { float32 = 1, fp4 = 13, fp8 = 14, fp16 = 15, fpn = 16 };

/// "float32", "fp4", "fp8", "fp16" or "fpn".
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
