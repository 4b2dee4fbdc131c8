// The warning about an opacity band of a scene that is too narrow for the table that pictures are made with.
#pragma once

#include <string>

#include "format/sidecar/scene.h"

namespace weir {

/// Returns a warning about the band that loses most (missed_band): "opacity 1 at 0.015259 to 0.0155642 of the range
/// (values 1000 to 1020) is taken as 0, since it lies between two of the 1024 entries that the range has; give a
/// narrower range". The values are left out if the scene has no range. Empty if no band is missed, and for a surface,
/// which has no opacity.
std::string opacity_warning(const Scene& scene);

}  // namespace weir
