/* Grids on a CUDA device, and volumes out of its memory: weir.h's companion, in libraries that were built with CUDA. */
#ifndef WEIR_CUDA_H
#define WEIR_CUDA_H

/* NOLINTBEGIN: clang-tidy has the rules of C++ */
#include "weir.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A grid in the memory of a device. One call at a time; kernels may read it as long as no call loads into it. */
typedef struct weir_cuda_grid weir_cuda_grid;

/* Copies `grid`, which weir_open has opened (one of weir_open_memory: WEIR_ERROR_USAGE), to the calling thread's
 * current device, by the fastest way that the system allows, after the work queued in `stream` (a cudaStream_t; NULL:
 * the legacy default stream, for callers compiled with default streams per thread, too; it waits for every stream made
 * without cudaStreamNonBlocking); the copy is complete when the call returns. *loaded is NULL for a new load, which the
 * caller frees by weir_cuda_free; or it is an earlier load on the same device, whose memory is reused: two of them play
 * a series of files, one loading while the other is rendered. After a failure an earlier load holds no grid.
 * WEIR_ERROR_IO where there is no device, or no room on it; WEIR_ERROR_INPUT where the file was changed meanwhile. */
WEIR_API weir_status weir_cuda_load(const weir_grid* grid, void* stream, weir_cuda_grid** loaded, weir_error* error);
/* The same of a packed grid, which is decoded on the device into a grid that every NanoVDB reader knows: `as` is
 * "float" (every decoded bit) or "fp16" (16 bits between the least and the largest value of each leaf). weir_cuda_bytes
 * then says what that takes; while it is made, the device holds the packed grid and up to 256 MiB beside it. Of a grid
 * that is not packed, `as` must be its own type. WEIR_ERROR_INPUT also where fp16 is to hold values that are not
 * finite, or blocks are damaged. Since 0.2. */
WEIR_API weir_status weir_cuda_load_as(const weir_grid* grid, const char* as, void* stream, weir_cuda_grid** loaded,
                                       weir_error* error);
/* The device's address of the grid, a multiple of 256, as weir_grid_data is the host's; NULL where there is none. */
WEIR_API const void* weir_cuda_data(const weir_cuda_grid* loaded);
WEIR_API uint64_t weir_cuda_bytes(const weir_cuda_grid* loaded); /* weir_grid_info's data_bytes */
WEIR_API double weir_cuda_seconds(const weir_cuda_grid* loaded); /* that loading took */
/* Waits for all work of the load's device first, as cudaFree does: a kernel may still read the grid. */
WEIR_API void weir_cuda_free(weir_cuda_grid* loaded);

/* ---- Push: a volume out of the memory of a device. Since 0.2 --------------------------------------------------- */

/* weir_push_slab for values on the calling thread's current device: `data` is the device's address of voxel (0, 0, z0),
 * memory that its kernels can read; it and the strides are multiples of the bytes of a value. The copy follows the
 * work queued in `stream` (see weir_cuda_load), and the call returns once it is queued: work that is queued there
 * afterwards may change the values. Slabs cross the bus through page-locked host memory: four pieces of 8 MiB, or two
 * planes where a plane is larger, besides options->memory; a call waits while these are full. Planes are checked as by
 * weir_push_slab. A failure of a copy ends the push, and is the status of a later call; where there is no room for
 * these pieces (WEIR_ERROR_IO at the first slab) nothing was taken, and the push can go on. All slabs come from one
 * device; values on another one must be without gaps. Slabs of weir_push_slab may come between. Where `data` is host
 * memory, or there is no device, it is taken as weir_push_slab takes it, once the work in `stream` is done. */
WEIR_API weir_status weir_push_slab_device(weir_push* push, int64_t z0, int64_t nz, const void* data,
                                           const int64_t stride[3], void* stream, weir_error* error);
/* Before the first slab of a device: up to `bytes` of its memory, a plane's or more, may hold slabs until they have
 * crossed the bus, in a stream of the lowest priority. A call then waits only while that is full. The memory is taken
 * with the first slab, and given back by weir_push_free.
 * Where that is enough for the whole volume, of WEIR_FLOAT32 without missing values, and the device does the work
 * (options->encoding packed, options->backend not WEIR_BACKEND_CPU, options->memory 1 GiB or more), its values stay
 * there: weir_push_end surveys and encodes them on that device, which takes 0.5 to 1 GB more of its memory (the most
 * where all is kept without loss), and only streams and figures cross the bus. The file has the same bytes. Of the
 * host's page-locked memory up to 96 MiB stay with the process, for the next step, and up to 1 GiB that the system
 * takes back where it needs memory (MADV_FREE). */
WEIR_API weir_status weir_push_device_memory(weir_push* push, uint64_t bytes, weir_error* error);
/* weir_convert for values on the device, after the work queued in `stream`: begins a push, takes one slab and ends.
 * Where the device does the work (weir_push_device_memory) and values have no gaps, they are coded where they are. */
WEIR_API weir_status weir_convert_device(const weir_volume* volume, const void* data, const int64_t stride[3],
                                         void* stream, const weir_convert_options* options, const char* output,
                                         weir_error* error);

#ifdef __cplusplus
}
#endif

/* NOLINTEND */
#endif /* WEIR_CUDA_H */
