// Builds the ladders that the survey cannot or should not build. Blocks with missing or non-finite values need the
// background, which replaces these values. Near rungs are only of use when the file keeps nearly everything.
#pragma once

#include "compressor/packed/ladder_builder.h"
#include "compressor/survey/row_store.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Which ladders are built anew.
struct MissingLadders {
  bool filled = false;  ///< the ladders of blocks with some values that are not finite; `aim.background` must be set
  bool all = false;     ///< the ladders of all blocks with two or more different values
};

/// Reads the blocks that `missing` names once more and sets their ladders in `rows`. The survey must be finished.
/// Throws as VolumeSource::read, and Error(input) if the source has changed since the survey.
void complete_ladders(VolumeSource& source, const BlockPlan& plan, RowStore& rows, const LadderAim& aim,
                      const MissingLadders& missing, const StreamOptions& options);

}  // namespace weir
