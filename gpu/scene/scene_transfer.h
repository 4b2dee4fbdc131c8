// The transfer function that a scene describes, with defaults that suit any volume: colours over the value range, and
// an opacity that grows with the distance from the background, so that the background is transparent.
#pragma once

#include <string_view>

#include "format/nanovdb/nvdb_grid.h"
#include "format/sidecar/scene.h"
#include "gpu/scene/transfer_function.h"

namespace weir {

/// Makes the transfer function. `range` is the grid's; the scene's own range replaces it. `default_colormap` is used
/// if the scene names none. Throws Error(usage) for an unknown colormap.
TransferFunction make_transfer_function(const SceneVolume& volume, MinMax range, float background,
                                        std::string_view default_colormap);

}  // namespace weir
