// The encode pass: reads only the blocks that hold kept leaves, and writes every kept leaf at its place in the file.
#pragma once

#include "compressor/encode/layer_encoder.h"
#include "compressor/resume/encoded_state.h"
#include "compressor/survey/pauses.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"

namespace weir {

/// Returns whether the values lie on a device that encodes their packed blocks region by region. EncodeTarget::regions
/// may then take the records. `resumes` says whether encode_leaves() gets a state.
bool encodes_by_regions(VolumeSource& source, bool packed, const Team& team, bool resumes);

/// Encodes all kept leaves. The bytes do not depend on the plan or the number of threads. If `state` is not null, it
/// holds what is already done, by any plan. It is updated when `pauses` ask for it and covers the whole lattice at the
/// end. Throws Error(input) if a leaf has other values than the survey saw.
void encode_leaves(VolumeSource& source, const BlockPlan& plan, const EncodeTarget& target,
                   const StreamOptions& options, Reading reading = Reading::ahead, EncodedState* state = nullptr,
                   const Pauses& pauses = {});

}  // namespace weir
