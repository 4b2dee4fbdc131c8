/* weir inside the processes of an MPI job: one volume that they hold in boxes becomes one file, with the bytes that
 * weir convert gives for all of it. Link with -lweir_mpi -lweir and MPI; weir.h says how calls end and what the structs
 * mean. MPI must be initialised with MPI_THREAD_SERIALIZED or more, and while any of these calls lasts, no other thread
 * of the process may call MPI.
 *
 * Output and work directory lie on a file system that all processes share. A failure of a collective call is the same
 * status and message in all of them; where one process fails by itself (out of memory, say), so that the others would
 * wait for it, weir ends the job (MPI_Abort). */
#ifndef WEIR_MPI_H
#define WEIR_MPI_H

#include <mpi.h>

#include "weir.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A volume on its way into a file. */
typedef struct weir_mpi_push weir_mpi_push;

/* Collective over `comm`, which is copied; volume, options and output are the same in all processes, or
 * WEIR_ERROR_USAGE (options->memory, threads and callbacks are each its own; threads 0: an equal part of the machine's
 * cores). Where the memory of one of them is too small, that is WEIR_ERROR_USAGE, too. Takes the output's lock. *push
 * is the caller's, for weir_mpi_push_free. */
WEIR_API weir_status weir_mpi_push_begin(MPI_Comm comm, const weir_volume* volume, const weir_convert_options* options,
                                         const char* output, weir_mpi_push** push, weir_error* error);
/* The same with Fortran's handle of the communicator. */
WEIR_API weir_status weir_mpi_push_begin_fortran(MPI_Fint comm, const weir_volume* volume,
                                                 const weir_convert_options* options, const char* output,
                                                 weir_mpi_push** push, weir_error* error);

/* Hands over the voxels [lo, lo + extent) of the volume: voxel (x, y, z) of the box is at data + x stride[0] +
 * y stride[1] + z stride[2] bytes; stride NULL: packed, x fastest. Of this process alone, any number of times, one call
 * at a time; the data is free when it returns. Asks options->cancel. In the end each voxel of the volume was given
 * once, by whomever. After WEIR_ERROR_USAGE nothing was taken and the push goes on; any other failure is also that of
 * weir_mpi_push_end. */
WEIR_API weir_status weir_mpi_push_box(weir_mpi_push* push, const int64_t lo[3], const int64_t extent[3],
                                       const void* data, const int64_t stride[3], weir_error* error);

/* Collective. Writes the file and its sidecar, both or neither. WEIR_ERROR_USAGE where voxels are missing, which can
 * still be given, or were given twice, which ends the push: free it. */
WEIR_API weir_status weir_mpi_push_end(weir_mpi_push* push, weir_error* error);
/* Collective. Ends a push that was not ended without an output, and frees it. NULL: nothing. */
WEIR_API void weir_mpi_push_free(weir_mpi_push* push);

#ifdef __cplusplus
}
#endif

#endif /* WEIR_MPI_H */
