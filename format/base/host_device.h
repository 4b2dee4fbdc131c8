// WEIR_HOST_DEVICE marks functions that the CUDA part compiles for host and device. On a device WEIR_UNROLL unrolls a
// loop that must run without indices, WEIR_NO_UNROLL keeps a loop as it is, and WEIR_NO_INLINE makes a function a real
// call.
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
