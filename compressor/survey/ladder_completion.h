// The ladders of packed blocks that the survey alone cannot build, or should not: of blocks in which values are
// missing or not finite, whose place the background takes, and the near rungs, of use where nearly everything is kept.
#pragma once

#include <cstdint>

#include "compressor/packed/ladder_builder.h"
#include "compressor/survey/row_store.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// What all blocks together take and lose where near rungs begin to be the better buy.
struct NearCost {
  double bytes = 0;
  double squared_error = 0;
};

/// Estimated from the ladders of the sampled blocks (compressor/packed/near_sample.h), of a finished survey. Throws as
/// File::read_at.
NearCost near_cost(const RowStore& rows);

/// Which ladders are built anew.
struct MissingLadders {
  bool filled = false;             ///< of blocks with some values that are not finite: `aim.background` is set
  NearRungs near = NearRungs::no;  ///< yes: of all, with near rungs
};

/// Reads those blocks once more and sets their ladders in `rows`, of a finished survey.
/// Throws as VolumeSource::read, Error(input) where the source has changed since the survey.
void complete_ladders(VolumeSource& source, const BlockPlan& plan, RowStore& rows, const LadderAim& aim,
                      const MissingLadders& missing, const StreamOptions& options);

}  // namespace weir
