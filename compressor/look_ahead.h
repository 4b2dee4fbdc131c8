// The look ahead before the survey of a volume that is to be packed. A sample of its blocks is surveyed first, so that
// the survey builds only the ladder rungs that the budget can use.
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

/// Surveys the sampled blocks and returns the outlook for the budget. Returns nullopt if no ladders with rungs are
/// built, if a scene weighs errors, or if looking ahead takes longer than it saves: for a small volume, or if it
/// would decode more than a quarter of the chunks. Writes rows and ladders of the sampled blocks, which the survey
/// writes again. Throws as VolumeSource::read() does.
std::optional<BudgetOutlook> look_ahead(VolumeSource& source, const ReadingPlan& reading, RowStore& rows,
                                        const ConversionOptions& options, const LadderAim& aim,
                                        const StreamOptions& stream);

}  // namespace weir
