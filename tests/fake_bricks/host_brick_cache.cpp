// The brick cache over what instead/ has in place of the device.
#include "gpu/cuda/bricks/brick_cache.cu"  // NOLINT(bugprone-suspicious-include)
