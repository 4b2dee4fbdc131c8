/* weir inside the processes of an MPI job: one volume that they hold in boxes becomes one file, with the same bytes as
 * the command weir convert for the whole volume. Link with -lweir_mpi -lweir and MPI. weir.h explains how calls end and
 * what the structs mean. MPI must be initialised with MPI_THREAD_SERIALIZED or more, and no other thread of the process
 * may call MPI while one of these calls lasts.
 *
 * Output and work directory lie on a file system that all processes share. If a collective call fails, it returns
 * the same status and message in all processes. If one process fails alone (for instance out of memory), so that the
 * others would wait for it, weir ends the job (MPI_Abort). */
#ifndef WEIR_MPI_H
#define WEIR_MPI_H

#include <mpi.h>

#include "weir.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A volume on its way into a file. */
typedef struct weir_mpi_push weir_mpi_push;

/* Begins `output`. Collective over `comm`, which is copied. Volume, options and output must be the same in all
 * processes; otherwise the call fails with WEIR_ERROR_USAGE. Only options->memory, threads and callbacks are each
 * process's own; threads 0: an equal share of the machine's cores. Also fails with WEIR_ERROR_USAGE if one process
 * has too little memory. Takes the output's lock. The caller frees *push with weir_mpi_push_free. */
WEIR_API weir_status weir_mpi_push_begin(MPI_Comm comm, const weir_volume* volume, const weir_convert_options* options,
                                         const char* output, weir_mpi_push** push, weir_error* error);
/* Like weir_mpi_push_begin, with Fortran's handle of the communicator. */
WEIR_API weir_status weir_mpi_push_begin_fortran(MPI_Fint comm, const weir_volume* volume,
                                                 const weir_convert_options* options, const char* output,
                                                 weir_mpi_push** push, weir_error* error);

/* Hands over the voxels [lo, lo + extent) of the volume: voxel (x, y, z) of the box is at data + x stride[0] +
 * y stride[1] + z stride[2] bytes; stride NULL: packed, x fastest. Not collective: a process may call it any number of
 * times, one call at a time; the data may change once the call has returned. Asks options->cancel. By the end, the
 * processes together must have given each voxel of the volume exactly once. After WEIR_ERROR_USAGE nothing was taken
 * and the push goes on; after any other failure weir_mpi_push_end fails in the same way. */
WEIR_API weir_status weir_mpi_push_box(weir_mpi_push* push, const int64_t lo[3], const int64_t extent[3],
                                       const void* data, const int64_t stride[3], weir_error* error);

/* Collective. Writes the file and its sidecar, both or neither. Fails with WEIR_ERROR_USAGE if voxels are missing
 * (they can still be given), or if voxels were given twice, which ends the push: free it. */
WEIR_API weir_status weir_mpi_push_end(weir_mpi_push* push, weir_error* error);
/* Collective. Frees a push; one that was not ended leaves no output. NULL: does nothing. */
WEIR_API void weir_mpi_push_free(weir_mpi_push* push);

#ifdef __cplusplus
}
#endif

#endif /* WEIR_MPI_H */
