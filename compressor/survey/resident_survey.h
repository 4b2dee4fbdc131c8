// The survey of packed blocks of a volume that lies on a device: its values do not cross the host's memory.
#pragma once

#include <span>

#include "compressor/packed/ladder_builder.h"
#include "compressor/survey/block_survey.h"
#include "compressor/survey/row_store.h"
#include "format/packed/block_coder.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Fills `rows` and their ladders with what survey_volume() finds of the same values, and returns what it returns. What
/// the device has no room for, or fails at, is done by reading `source`, which has those values. Throws as
/// VolumeSource::read, and Error(interrupted).
Survey survey_resident(ResidentVolume& resident, VolumeSource& source, RowStore& rows, const LadderAim& ladders,
                       const StreamOptions& options);

/// The same of some boxes of blocks (lattice positions), which are all of them sampled ones (BlockSample), without the
/// figures of the whole.
void survey_resident_sample(ResidentVolume& resident, VolumeSource& source, RowStore& rows, const LadderAim& ladders,
                            std::span<const Box> boxes, const StreamOptions& options);

}  // namespace weir
