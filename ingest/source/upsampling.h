// What fine voxels read where only coarser cells have values.
#pragma once

#include <string_view>

namespace weir {

enum class Upsampling {
  constant,  ///< the value of the coarse cell they lie in
  linear     ///< trilinear between the centres of coarse cells
};

constexpr std::string_view upsampling_name(Upsampling upsampling) {
  return upsampling == Upsampling::constant ? "constant" : "linear";
}

}  // namespace weir
