// What voxels of chunks read that an array does not store.
#pragma once

namespace weir {

enum class MissingChunks {
  fill,  ///< the array's fill value, as its format says
  error  ///< nothing: such an array is refused
};

}  // namespace weir
