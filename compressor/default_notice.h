// The notice about a file that was converted without a budget: how much of the values the default kept.
#pragma once

#include <string>

#include "format/base/message.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// Returns one line if the default rate would have kept less than kDefaultLeastDb and so a larger file was written, or
/// if the written file keeps less than kDefaultLeastDb. Otherwise empty. With a scene, only visible voxels count.
Message default_notice(const Sidecar& sidecar, const std::string& output);

}  // namespace weir
