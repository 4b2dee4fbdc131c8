// Voxels without a number, which a conversion refuses unless something else was asked for, and with one that float32
// does not hold.
#pragma once

#include "compressor/conversion_options.h"
#include "compressor/survey/survey_figures.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Throws Error(input) with count, first place and the options to choose from where voxels are NaN or infinite, or hold
/// no data, and `options` leave it at the error that this is by default. Throws Error(budget) where float32 rounds
/// values by more than the largest error that `options` allow.
void refuse_values(const ConversionOptions& options, const Survey& survey, const SourceInfo& info);

}  // namespace weir
