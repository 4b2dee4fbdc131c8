// What is said of a scene that leaves nothing of a volume to be seen.
#pragma once

#include "format/base/message.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// One line, where the sidecar's scene shows nothing: then no block matters more than another. Else empty.
Message scene_notice(const Sidecar& sidecar, const std::string& output);

}  // namespace weir
