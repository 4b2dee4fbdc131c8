// Small volumes for what looks at packed blocks: smooth ones, noise, and each hard case.
#pragma once

#include <string>
#include <vector>

#include "format/base/index.h"

namespace weir::test {

/// Values at voxels of a box, x fastest.
struct BlockVolume {
  std::string name;
  Index3 extent;
  std::vector<float> values;

  bool all_finite() const;
};

std::vector<BlockVolume> block_volumes();

/// Volumes each of whose blocks has another size, roughness and share of zeros.
std::vector<BlockVolume> mixed_volumes();

/// One of them. Throws std::out_of_range where there is none of that name.
BlockVolume block_volume(const std::string& name);

}  // namespace weir::test
