// An index as OpenVDB and NanoVDB write it.
#pragma once

#include "format/base/index.h"

namespace weir::test {

/// `Coord` is openvdb::Coord or nanovdb::Coord, both of three ints.
template <typename Coord>
Coord coord(const Index3& i) {
  return Coord(static_cast<int>(i.x), static_cast<int>(i.y), static_cast<int>(i.z));
}

}  // namespace weir::test
