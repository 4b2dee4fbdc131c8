// What is said of a file that was made: what the scene and the default did to it.
#pragma once

#include "compressor/conversion_options.h"
#include "format/base/message.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// Gives scene_notice and, where nobody asked for a size, default_notice to `notice`, which may be empty.
void say_result(const Sidecar& sidecar, const ConversionOptions& options, const Notice& notice);

}  // namespace weir
