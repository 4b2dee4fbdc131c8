// The grid types of OpenVDB that weir reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "format/base/scalar_type.h"

namespace weir {

/// The content of a leaf after its mask of active voxels.
enum class VdbLeaf {
  values,   ///< 512 values, perhaps compressed
  boolean,  ///< one bit a voxel
  mask      ///< nothing: a voxel's value is whether it is active
};

struct VdbType {
  std::string_view tree;  ///< as the file names it
  ScalarType scalar;      ///< how weir calls its values; uint8 0 and 1 for bool and mask
  std::size_t bytes;      ///< of a value in tiles and unpacked leaves, all its components together
  VdbLeaf leaf;
  bool real;                    ///< may be saved as 16-bit floats
  std::int64_t components = 1;  ///< 3 of vectors
};

/// Returns the type of the trees called `name`; null if weir does not read them.
const VdbType* vdb_type(std::string_view name);

}  // namespace weir
