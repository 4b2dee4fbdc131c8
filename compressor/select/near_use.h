// Whether a budget has a use for near rungs (compressor/packed/packed_ladder.h), which the survey builds for a sample
// of the blocks only.
#pragma once

#include "compressor/select/encoding_choice.h"
#include "compressor/survey/row_store.h"

namespace weir {

/// Whether the best packed file for a budget of bytes or of a PSNR keeps some blocks by near rungs or as floats in
/// order, judged by the sampled blocks (compressor/packed/near_sample.h) whose values are all finite. The same on all
/// ranks; ladders that are completed later do not change it. Throws as File::read_at.
bool uses_near_rungs(const FileRequest& request, const RowStore& rows);

}  // namespace weir
