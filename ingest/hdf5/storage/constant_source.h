// A volume with the same value everywhere, such as an openPMD constant component.
#pragma once

#include <memory>

#include "ingest/source/volume_source.h"

namespace weir {

/// Returns a source that is `value` in the whole domain of `info`. The value counts as float64, and info.mapping is
/// applied.
std::unique_ptr<VolumeSource> make_constant_source(double value, SourceInfo info);

}  // namespace weir
