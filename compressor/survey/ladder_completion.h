// The ladders of packed blocks that the survey alone cannot build, or should not: of blocks in which values are
// missing or not finite, whose place the background takes, and the near rungs, of use where nearly everything is kept.
#pragma once

#include "compressor/packed/ladder_builder.h"
#include "compressor/survey/row_store.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Which ladders are built anew.
struct MissingLadders {
  bool filled = false;  ///< of blocks with some values that are not finite: `aim.background` is set
  bool all = false;     ///< those and all others
};

/// Reads those blocks once more and sets their ladders in `rows`, of a finished survey.
/// Throws as VolumeSource::read, Error(input) where the source has changed since the survey.
void complete_ladders(VolumeSource& source, const BlockPlan& plan, RowStore& rows, const LadderAim& aim,
                      const MissingLadders& missing, const StreamOptions& options);

}  // namespace weir
