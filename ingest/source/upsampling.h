// How fine voxels get values where only coarser cells have some.
#pragma once

#include <string_view>

namespace weir {

enum class Upsampling {
  constant,  ///< the value of the coarse cell that holds the voxel
  linear     ///< trilinear between the centres of coarse cells
};

constexpr std::string_view upsampling_name(Upsampling upsampling) {
  return upsampling == Upsampling::constant ? "constant" : "linear";
}

}  // namespace weir
