// The notice about a scene that shows nothing of a volume.
#pragma once

#include "format/base/message.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// Returns one line if the sidecar's scene shows nothing, so that no block matters more than another. Otherwise empty.
Message scene_notice(const Sidecar& sidecar, const std::string& output);

}  // namespace weir
