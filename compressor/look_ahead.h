// Before the survey of a volume that is to be packed: its sampled blocks are surveyed by themselves, so that all blocks
// get only the ladders that the budget can use.
#pragma once

#include <optional>

#include "compressor/conversion_options.h"
#include "compressor/outlook/budget_outlook.h"
#include "compressor/packed/ladder_builder.h"
#include "compressor/plan/reading_plan.h"
#include "compressor/survey/row_store.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// nullopt where that takes longer than it saves: of a small volume, of one whose chunks would nearly all be decoded
/// for it, where a scene weighs, and where no ladders of many rungs are built. Writes rows and ladders of the sampled
/// blocks, which the survey writes again. Throws as VolumeSource::read.
std::optional<BudgetOutlook> look_ahead(VolumeSource& source, const ReadingPlan& reading, RowStore& rows,
                                        const ConversionOptions& options, const LadderAim& aim,
                                        const StreamOptions& stream);

}  // namespace weir
