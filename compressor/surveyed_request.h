// The requests that a conversion makes of its selection, from its options and the survey.
#pragma once

#include <cstdint>

#include "compressor/conversion_options.h"
#include "compressor/select/encoding_choice.h"
#include "compressor/survey/survey.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Returns the request without its packed part, reaches and errors. `background` takes the place of values that are not
/// finite, unless the options keep them.
FileRequest request_for(const ConversionOptions& options, const Survey& survey, const SourceInfo& info,
                        float background);
/// Returns the packed part of the request.
PackedRequest packed_request(const ConversionOptions& options, const Survey& survey, const SourceInfo& info,
                             float background);

/// Returns whether the default rate gives way to a larger file if it keeps too little. With fewer than 128^3 voxels,
/// the tree takes most of the default rate's bytes, so that the values kept are no result. Errors that a scene weighs
/// and the paper's metrics have no such bound, and FP4 does not reach every bound.
bool raises_default(const ConversionOptions& options, const Box& domain);

/// Returns the squared error, summed over `finite` voxels, that the budget's PSNR allows.
double allowed_error(const Budget& budget, const Survey& survey, std::uint64_t finite);

}  // namespace weir
