// The notices about a finished file: what the scene, float32 and the default budget did to it.
#pragma once

#include "compressor/conversion_options.h"
#include "format/base/message.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// Tells `notice`, which may be empty, how much the values lost as float32, unless that is far less than the file's own
/// error.
void say_loss(const Sidecar& sidecar, const ConversionOptions& options, const Notice& notice);

/// Gives scene_notice(), say_loss() and, if no budget was asked for, default_notice() to `notice`, which may be empty.
void say_result(const Sidecar& sidecar, const ConversionOptions& options, const Notice& notice);

}  // namespace weir
