/* Grids on a CUDA device, and volumes from its memory: the companion of weir.h, in libraries that were built with
 * CUDA. */
#ifndef WEIR_CUDA_H
#define WEIR_CUDA_H

/* NOLINTBEGIN: clang-tidy has the rules of C++ */
#include "weir.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A grid in the memory of a device. Make one call at a time; kernels may read the grid while no call loads into it. */
typedef struct weir_cuda_grid weir_cuda_grid;

/* Copies `grid`, which weir_open has opened, to the calling thread's current device, by the fastest way that the system
 * allows. A grid of weir_open_memory is WEIR_ERROR_USAGE. The copy follows the work queued in `stream` and is complete
 * when the call returns. `stream` is a cudaStream_t; NULL is the legacy default stream, also for callers compiled with
 * per-thread default streams; it waits for every stream made without cudaStreamNonBlocking.
 * *loaded is NULL for a new load, which the caller frees with weir_cuda_free. Or it is an earlier load on the same
 * device, and its memory is reused: with two loads a program plays a series of files, loading one while it renders the
 * other. After a failure an earlier load holds no grid.
 * Fails with WEIR_ERROR_IO if there is no device, or no room on it, and with WEIR_ERROR_INPUT if the file was
 * changed in the meantime. */
WEIR_API weir_status weir_cuda_load(const weir_grid* grid, void* stream, weir_cuda_grid** loaded, weir_error* error);
/* Like weir_cuda_load, but decodes a packed grid on the device into a grid that every NanoVDB reader knows: `as` is
 * "float" (every decoded bit) or "fp16" (16 bits between the least and the largest value of each leaf).
 * weir_cuda_bytes then returns the size of the decoded grid; while it is made, the device also holds the packed grid
 * and up to 256 MiB. For a grid that is not packed, `as` must be its own type. Also fails with WEIR_ERROR_INPUT if
 * fp16 is asked for and values are not finite, or if blocks are damaged. Since 0.2. */
WEIR_API weir_status weir_cuda_load_as(const weir_grid* grid, const char* as, void* stream, weir_cuda_grid** loaded,
                                       weir_error* error);
/* Returns the grid's address on the device, a multiple of 256: what weir_grid_data is on the host. NULL if there is
 * no grid. */
WEIR_API const void* weir_cuda_data(const weir_cuda_grid* loaded);
WEIR_API uint64_t weir_cuda_bytes(const weir_cuda_grid* loaded); /* weir_grid_info's data_bytes */
WEIR_API double weir_cuda_seconds(const weir_cuda_grid* loaded); /* duration of the load */
/* Frees the load. Waits for all work of the load's device first, as cudaFree does, because a kernel may still read
 * the grid. */
WEIR_API void weir_cuda_free(weir_cuda_grid* loaded);

/* ---- Push: a volume out of the memory of a device. Since 0.2 --------------------------------------------------- */

/* Like weir_push_slab, for values on the calling thread's current device: `data` is the device's address of voxel
 * (0, 0, z0), in memory that its kernels can read; `data` and the strides are multiples of the bytes of a value. The
 * copy follows the work queued in `stream` (see weir_cuda_load). The call returns once the copy is queued: work that is
 * queued in `stream` afterwards may change the values.
 * Slabs cross the bus through page-locked host memory: four pieces of 8 MiB, or two planes if a plane is larger,
 * besides options->memory; a call waits while these are full. Planes are checked as by weir_push_slab. If a copy fails,
 * the push ends, and a later call returns the status. If there is no room for these pieces (WEIR_ERROR_IO at the first
 * slab), nothing was taken, and the push can go on.
 * Make every call with the same device current; values that lie on another device must be without gaps. Slabs of
 * weir_push_slab may come in between. If `data` is host memory, or there is no device, the slab is taken as
 * weir_push_slab takes it, once the work in `stream` is done. */
WEIR_API weir_status weir_push_slab_device(weir_push* push, int64_t z0, int64_t nz, const void* data,
                                           const int64_t stride[3], void* stream, weir_error* error);
/* Grants device memory; call it before the first slab of a device. Up to `bytes` of the device's memory, at least a
 * plane's, may hold slabs until they have crossed the bus, in a stream of the lowest priority. A call then waits only
 * while that memory is full. The memory is taken with the first slab, and given back by weir_push_free.
 * If it is enough for the whole volume, the values stay on the device under these conditions: WEIR_FLOAT32 without
 * missing values, options->encoding packed, options->backend not WEIR_BACKEND_CPU, options->memory 1 GiB or more.
 * weir_push_end then surveys and encodes them on that device, which takes 0.5 to 1 GB more of its memory (most if
 * everything is kept without loss), and only streams and figures cross the bus. The file has the same bytes. Up to
 * 96 MiB of page-locked host memory stay with the process for the next step. So does up to 1 GiB of ordinary memory,
 * which the system takes back when it needs memory (MADV_FREE). */
WEIR_API weir_status weir_push_device_memory(weir_push* push, uint64_t bytes, weir_error* error);
/* Like weir_convert, for values on the device, after the work queued in `stream`: begins a push, takes one slab and
 * ends. If the device does the work (see weir_push_device_memory) and values have no gaps, they are encoded where
 * they are. */
WEIR_API weir_status weir_convert_device(const weir_volume* volume, const void* data, const int64_t stride[3],
                                         void* stream, const weir_convert_options* options, const char* output,
                                         weir_error* error);

#ifdef __cplusplus
}
#endif

/* NOLINTEND */
#endif /* WEIR_CUDA_H */
