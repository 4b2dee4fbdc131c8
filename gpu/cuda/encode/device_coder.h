// A CUDA device that surveys and encodes packed blocks for a conversion (format/packed/block_coder.h).
#pragma once

#include <functional>
#include <memory>

#include "format/base/error.h"
#include "format/packed/block_coder.h"

namespace weir {

/// Makes a coder that uses `device` and the built-in tables. It takes device memory as it needs it: about 70 bytes
/// for each voxel of a box that is encoded and 4.7 for each voxel that is surveyed, for as many boxes as threads are
/// at work. A failure of the device, including a lack of memory, ends the coder's work and is passed to `failed`
/// once. Throws the errors of use_device(), and Error(io) if there is no room for the tables.
std::unique_ptr<BlockCoder> make_device_coder(int device, std::function<void(const Error&)> failed);

}  // namespace weir
