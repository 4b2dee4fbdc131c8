// A packed grid as a grid that every NanoVDB reader knows, in device memory: for renderers of others.
#pragma once

#include "gpu/cuda/grid_loader.h"

namespace weir {

/// As load_grid, but decodes a packed grid on the device, into leaves of floats (`as` float32: every decoded bit) or of
/// 16 bits between each leaf's least and largest value (`as` fp16). Its nodes have the statistics and the grid the head
/// checksum that NanoVDB's tools look at. Until it returns, the device holds the packed grid and up to 256 MiB beside
/// it. A grid that is not packed is copied where it is of that type already. options.zero_copy is of the packed grid
/// alone.
///
/// Throws Error(usage) where `as` is another type, Error(input) where the grid is of another type and not packed, where
/// blocks are damaged, and where fp16 is to hold values that are not finite; and as load_grid.
DeviceGrid load_grid_as(const NvdbFile& file, GridType as, DeviceBuffer&& buffer, const LoadOptions& options = {},
                        cudaStream_t stream = nullptr);

}  // namespace weir
