// How chunks that an array does not store are read.
#pragma once

namespace weir {

enum class MissingChunks {
  fill,  ///< the array's fill value, as its format says
  error  ///< an array with missing chunks is refused
};

}  // namespace weir
