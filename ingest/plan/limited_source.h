// A volume whose reading keeps to a bandwidth.
#pragma once

#include <memory>

#include "format/io/bandwidth.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// `source`, but its reads return no sooner than `bandwidth` allows for the bytes that VolumeSource::bytes_read counts,
/// those that opening it took among them. What it reads is the same. `bandwidth` must outlive it.
std::unique_ptr<VolumeSource> limit_source(std::unique_ptr<VolumeSource> source, Bandwidth& bandwidth);

}  // namespace weir
