// The stream that a caller passes.
#pragma once

#include <driver_types.h>

namespace weir {

/// Returns `stream`, or for a null stream the legacy default stream. Work that waits for the result waits for the
/// caller's default stream, whether or not the caller was compiled with a default stream per thread. This library is
/// compiled with one per thread: here a null stream would be the calling thread's own and would not wait for the
/// caller's work.
inline cudaStream_t caller_stream(cudaStream_t stream) { return stream == nullptr ? cudaStreamLegacy : stream; }

}  // namespace weir
