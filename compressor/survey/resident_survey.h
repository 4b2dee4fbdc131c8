// Surveys the packed blocks of a volume that lies on a device. Values reach the host's memory only for the blocks that
// the device leaves to the host.
#pragma once

#include <span>

#include "compressor/packed/ladder_builder.h"
#include "compressor/survey/block_survey.h"
#include "compressor/survey/row_store.h"
#include "format/packed/block_coder.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Fills `rows` and their ladders, and returns the survey, exactly as survey_volume() does for the same values. Where
/// the device has no room or fails, the host reads the values from `source`, which holds the same volume. Throws as
/// VolumeSource::read, and Error(interrupted).
Survey survey_resident(ResidentVolume& resident, VolumeSource& source, RowStore& rows, const LadderAim& ladders,
                       const StreamOptions& options);

/// Does the same for `boxes` of blocks (lattice positions) only, and does not compute the figures of the whole volume.
/// Each box is a row of blocks along x, one block thick, and all its blocks are in the sample (BlockSample).
void survey_resident_sample(ResidentVolume& resident, VolumeSource& source, RowStore& rows, const LadderAim& ladders,
                            std::span<const Box> boxes, const StreamOptions& options);

}  // namespace weir
