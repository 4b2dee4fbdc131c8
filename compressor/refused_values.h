// The values that a conversion refuses by default: NaN, infinite and missing ones, and values that float32 cannot hold
// exactly enough.
#pragma once

#include "compressor/conversion_options.h"
#include "compressor/survey/survey_figures.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Throws Error(input) with count, first place and the options to choose from if voxels are NaN or infinite, or hold no
/// data, and the policy in `options` is the default, which is an error. Throws Error(budget) if float32 rounds values
/// by more than the largest error that `options` allow.
void refuse_values(const ConversionOptions& options, const Survey& survey, const SourceInfo& info);

/// Throws Error(input) with count, first place and the options to choose from if voxels hold no data.
void refuse_missing(const Survey& survey, const SourceInfo& info);

}  // namespace weir
