// Starts the kernels that survey and encode packed blocks.
#pragma once

#include <cuda_runtime_api.h>

#include "gpu/cuda/encode/encode_call.h"

namespace weir {

/// survey_block() of each block of the box, in a stream of the current device, where all of the call's memory lies.
/// Throws Error(io).
void launch_survey(const SurveyCall& call, cudaStream_t stream);

/// survey_near_rungs() of each block of the box, after launch_survey().
void launch_near_survey(const NearCall& call, cudaStream_t stream);

/// code_block() or code_lattice_block(), put_words() and put_bytes() of each ask.
void launch_encode(const EncodeCall& call, cudaStream_t stream);

/// add_statistics() and make_record() of each ask, whose streams were written before.
void launch_records(const RecordCall& call, cudaStream_t stream);

/// summarize_block() of each block of the box.
void launch_summaries(const SummaryCall& call, cudaStream_t stream);

/// copy_block() of each block that is wanted.
void launch_values(const ValuesCall& call, cudaStream_t stream);

/// Adds each value to the count of bin_of_value().
void launch_count(const CountCall& call, cudaStream_t stream);

}  // namespace weir
