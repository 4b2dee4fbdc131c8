// What is said of a file that was made: what the scene, float32 and the default did to it.
#pragma once

#include "compressor/conversion_options.h"
#include "format/base/message.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// Tells `notice`, which may be empty, what float32 lost of the values, where that is not far less than the file's
/// own error.
void say_loss(const Sidecar& sidecar, const ConversionOptions& options, const Notice& notice);

/// Gives scene_notice, say_loss and, where nobody asked for a size, default_notice to `notice`, which may be empty.
void say_result(const Sidecar& sidecar, const ConversionOptions& options, const Notice& notice);

}  // namespace weir
