// WEIR_HOST_DEVICE marks functions that the CUDA part compiles for both sides.
#pragma once

#if defined(__CUDACC__)
#define WEIR_HOST_DEVICE __host__ __device__
#else
#define WEIR_HOST_DEVICE
#endif
