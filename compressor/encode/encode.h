// The encode pass: reads the blocks that hold kept leaves, and only those, and
// writes every leaf at its place in the file.
#pragma once

#include "compressor/encode/layer_encoder.h"
#include "compressor/resume/encoded_state.h"
#include "compressor/survey/pauses.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"

namespace weir {

/// Whether the values lie on a device that encodes packed blocks of them, region by region, so that a target's
/// `regions` may take the records. `resumes`: there is a state.
bool encodes_by_regions(VolumeSource& source, bool packed, const Team& team, bool resumes);

/// Encodes all kept leaves; the bytes do not depend on the plan or the number of threads. `state`, where given, holds
/// what is done already, by any plan; it is updated when `pauses` ask for it, and is of the whole lattice in the end.
/// Throws Error(input) where the values of a leaf are not those that the survey saw.
void encode_leaves(VolumeSource& source, const BlockPlan& plan, const EncodeTarget& target,
                   const StreamOptions& options, Reading reading = Reading::ahead, EncodedState* state = nullptr,
                   const Pauses& pauses = {});

}  // namespace weir
