// The stream that a caller names.
#pragma once

#include <driver_types.h>

namespace weir {

/// `stream`, and for a null one the legacy default stream, whether or not the caller was compiled with a default stream
/// for each thread: what waits for it waits for the caller's default stream in both cases. In this library, which has
/// one for each thread, a null stream would be the calling thread's, and not wait for what the caller queued.
inline cudaStream_t caller_stream(cudaStream_t stream) { return stream == nullptr ? cudaStreamLegacy : stream; }

}  // namespace weir
