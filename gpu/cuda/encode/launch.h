// Starts the kernels that survey and encode packed blocks.
#pragma once

#include <cuda_runtime_api.h>

#include "gpu/cuda/encode/encode_call.h"

namespace weir {

/// Runs survey_block() for each block of the box, in a stream of the current device, which holds all of the call's
/// memory. Throws Error(io).
void launch_survey(const SurveyCall& call, cudaStream_t stream);

/// Runs survey_near_rungs() for each block of the box, after launch_survey().
void launch_near_survey(const NearCall& call, cudaStream_t stream);

/// Runs code_block() or code_lattice_block(), then put_words() and put_bytes() for each ask.
void launch_encode(const EncodeCall& call, cudaStream_t stream);

/// Runs add_statistics() and make_record() for each ask; its streams were written before.
void launch_records(const RecordCall& call, cudaStream_t stream);

/// Runs summarize_block() for each block of the box.
void launch_summaries(const SummaryCall& call, cudaStream_t stream);

/// Runs copy_block() for each wanted block.
void launch_values(const ValuesCall& call, cudaStream_t stream);

/// Adds each value to the count of bin_of_value().
void launch_count(const CountCall& call, cudaStream_t stream);

}  // namespace weir
