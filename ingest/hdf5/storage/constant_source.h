// A volume that is one value everywhere, as openPMD's constant components are.
#pragma once

#include <memory>

#include "ingest/source/volume_source.h"

namespace weir {

/// `value`, which is counted as one of float64, in all of info's domain; info.mapping is applied.
std::unique_ptr<VolumeSource> make_constant_source(double value, SourceInfo info);

}  // namespace weir
