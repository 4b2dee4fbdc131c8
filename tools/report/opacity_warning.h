// What is said of a scene's opacity that is too narrow for the table which pictures are made with.
#pragma once

#include <string>

#include "format/sidecar/scene.h"

namespace weir {

/// "opacity 1 at 0.015259 to 0.0155642 of the range (values 1000 to 1020) is taken as 0, since it lies between two of
/// the 1024 entries that the range has; give a narrower range", of the band that loses most (missed_band). The values
/// are left out where the scene has no range. Empty where no band is missed, and of a surface, which has no opacity.
std::string opacity_warning(const Scene& scene);

}  // namespace weir
