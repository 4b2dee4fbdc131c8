// The ladders of packed blocks in which some values are missing or not finite: what takes their place is found by the
// survey, which therefore cannot build them.
#pragma once

#include "compressor/packed/ladder_builder.h"
#include "compressor/survey/row_store.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Reads those blocks once more and sets their ladders in `rows`, of a finished survey. `aim.background` is set.
/// Throws as VolumeSource::read, Error(input) where the source has changed since the survey.
void build_filled_ladders(VolumeSource& source, const BlockPlan& plan, RowStore& rows, const LadderAim& aim,
                          const StreamOptions& options);

}  // namespace weir
