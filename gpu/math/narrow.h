// Converts the host's 64-bit indices and doubles to the 32-bit numbers of the tracers.
#pragma once

#include <array>

#include "format/base/index.h"
#include "gpu/math/vector3.h"

namespace weir {

/// `i` must fit 32 bits along each axis.
inline Int3 narrow(const Index3& i) {
  return {static_cast<std::int32_t>(i.x), static_cast<std::int32_t>(i.y), static_cast<std::int32_t>(i.z)};
}

inline Float3 narrow(const std::array<double, 3>& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

}  // namespace weir
