// Expands a packed grid in device memory to a grid that every NanoVDB reader can read, for other renderers.
#pragma once

#include "gpu/cuda/grid_loader.h"

namespace weir {

/// Loads a grid as load_grid() does, but decodes a packed grid on the device. Its leaves hold floats (`as` float32:
/// every decoded bit), or 16 bits between each leaf's least and largest value (`as` fp16). The nodes have the
/// statistics, and the grid the head checksum, that NanoVDB's tools read. Until the call returns, the device also
/// holds the packed grid and up to 256 MiB. A grid that is not packed is copied if its type is `as` already.
/// options.zero_copy applies only to the packed grid.
///
/// Throws Error(usage) if `as` is another type. Throws Error(input) if a grid that is not packed has another type, if
/// blocks are damaged, or if fp16 would have to hold values that are not finite. Also throws the errors of
/// load_grid().
DeviceGrid load_grid_as(const NvdbFile& file, GridType as, DeviceBuffer&& buffer, const LoadOptions& options = {},
                        cudaStream_t stream = nullptr);

}  // namespace weir
