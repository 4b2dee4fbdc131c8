// A source that reads no faster than a given bandwidth.
#pragma once

#include <memory>

#include "format/io/bandwidth.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Returns a source with the values of `source`. Its reads return no sooner than `bandwidth` allows for the bytes
/// that VolumeSource::bytes_read counts, including those of opening it. `bandwidth` must outlive the returned source.
std::unique_ptr<VolumeSource> limit_source(std::unique_ptr<VolumeSource> source, Bandwidth& bandwidth);

}  // namespace weir
