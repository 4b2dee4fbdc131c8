// WEIR_HOST_DEVICE marks functions that the CUDA part compiles for both sides, WEIR_UNROLL their loops that a device
// has to run without indices, WEIR_NO_UNROLL those it is to run as they are, WEIR_NO_INLINE functions it is to call.
#pragma once

#if defined(__CUDACC__)
#define WEIR_HOST_DEVICE __host__ __device__
#else
#define WEIR_HOST_DEVICE
#endif

#if defined(__CUDA_ARCH__)
#define WEIR_UNROLL _Pragma("unroll")
#define WEIR_NO_UNROLL _Pragma("unroll 1")
#define WEIR_NO_INLINE __noinline__
#else
#define WEIR_UNROLL
#define WEIR_NO_UNROLL
#define WEIR_NO_INLINE
#endif
