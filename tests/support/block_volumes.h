// Small volumes for tests of packed blocks: smooth ones, noise, and each hard case.
#pragma once

#include <string>
#include <vector>

#include "format/base/index.h"

namespace weir::test {

/// The values of a box of voxels, x fastest.
struct BlockVolume {
  std::string name;
  Index3 extent;
  std::vector<float> values;

  bool all_finite() const;
};

std::vector<BlockVolume> block_volumes();

/// Returns volumes with blocks that all differ in magnitude, roughness and share of zeros.
std::vector<BlockVolume> mixed_volumes();

/// Returns one of these volumes. Throws std::out_of_range if none has that name.
BlockVolume block_volume(const std::string& name);

}  // namespace weir::test
