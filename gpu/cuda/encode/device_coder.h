// A CUDA device as what surveys and encodes packed blocks for a conversion (format/packed/block_coder.h).
#pragma once

#include <functional>
#include <memory>

#include "format/base/error.h"
#include "format/packed/block_coder.h"

namespace weir {

/// Uses `device`, by the built-in tables, and takes memory there as it needs it: 70 bytes or so for each voxel of a box
/// that is encoded, 4.7 for one that is surveyed, of as many boxes as there are threads at work. What goes wrong, room
/// that there is not among it, ends its work and is said to `failed`, once. Throws Error as use_device() does, and
/// Error(io) where there is no room for the tables.
std::unique_ptr<BlockCoder> make_device_coder(int device, std::function<void(const Error&)> failed);

}  // namespace weir
