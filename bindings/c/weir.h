/* weir's C interface. It converts dense volumes, from memory, from a file or from a running simulation, to NanoVDB
 * files of exactly the requested size, and reads the values of such files. C99; also for C++, and for Fortran through
 * iso_c_binding (examples/push/weir.f90).
 *
 * Errors: every call that can fail returns a weir_status, and describes a failure in *error if error is not NULL. The
 * message is one line: what happened, where, the value found, what to do. If it names an option of the command ("choose
 * --nonfinite keep"), it means the struct member of that name. A failed call leaves nothing behind and does not set its
 * results. There is no global state and no last error. No C++ exception leaves the library, and none may leave a
 * callback.
 *
 * Threads: any thread may make a call at any time, and several threads may make calls with different handles at once.
 * The comment of a handle's type tells what that handle allows. Conversions use threads of oneTBB and limit their
 * number for the whole process while they run: several conversions, and oneTBB loops of the program itself, then run
 * with the smallest number of threads that one of them was given. Conversions compute in a floating-point mode of
 * their own, whatever the caller's mode is (-ffast-math, rounding), and restore the caller's mode afterwards. A child
 * that is forked while a conversion runs can convert only after exec, and gets WEIR_ERROR_USAGE before; any other
 * child may convert. oneTBB's threads go on after a conversion, so dlclose leaves the library loaded. A thread that
 * makes a call needs a stack of at least 256 KiB, besides what its callbacks take.
 *
 * Signals: the library changes no signal's action. A file that would grow beyond the limit of file size (ulimit -f) is
 * WEIR_ERROR_IO, without the signal SIGXFSZ.
 *
 * Structs: set up every struct with its _init function and its sizeof, then change members; 0 or NULL is always a
 * member's default. A program built with an older weir.h runs with a newer library. A program built with a newer weir.h
 * runs with an older library if it sets nothing that the library does not know. Strings end with a zero; paths are as
 * the system takes them. A pointer that is not described as optional must not be NULL: NULL is WEIR_ERROR_USAGE, and so
 * is a value out of its range. Handles are not checked otherwise. Every _free and _close accepts NULL.
 *
 * Indices and extents are of voxels, in the order x, y, z, with x fastest in files and packed arrays. */
#ifndef WEIR_H
#define WEIR_H

/* NOLINTBEGIN: clang-tidy has the rules of C++ */
#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define WEIR_API __attribute__((visibility("default")))
#else
#define WEIR_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Status ---------------------------------------------------------------------------------------------------- */

/* The result of a call: the exit codes of the command weir. */
typedef int32_t weir_status;
enum {
  WEIR_OK = 0,
  WEIR_ERROR_INTERNAL = 1, /* a fault of weir itself, an exception of a callback, or no memory left */
  WEIR_ERROR_USAGE = 2,    /* a wrong argument or option, or a call out of order */
  WEIR_ERROR_INPUT = 3,    /* bad input, or none */
  WEIR_ERROR_BUDGET = 4,   /* the requested size cannot be met; the message names the smallest */
  WEIR_ERROR_IO = 5,       /* disk full, permission, device failure, a limit of threads, open files or file size */
  WEIR_INTERRUPTED = 130   /* the cancel callback asked to stop */
};

#define WEIR_MESSAGE_BYTES 2044
typedef struct weir_error {
  weir_status status;
  char message[WEIR_MESSAGE_BYTES]; /* ends with a zero; "..." for its middle if it is too long; "" after a success */
} weir_error;

/* Returns "0.2.0". The library owns the string. */
WEIR_API const char* weir_version(void);

/* ---- Volumes --------------------------------------------------------------------------------------------------- */

/* Scalar types, in the machine's byte order. */
enum {
  WEIR_UINT8 = 1,
  WEIR_INT8 = 2,
  WEIR_UINT16 = 3,
  WEIR_INT16 = 4,
  WEIR_UINT32 = 5,
  WEIR_INT32 = 6,
  WEIR_UINT64 = 7,
  WEIR_INT64 = 8,
  WEIR_FLOAT16 = 9,
  WEIR_FLOAT32 = 10,
  WEIR_FLOAT64 = 11,
  WEIR_BFLOAT16 = 12 /* the upper half of a float32. Since 0.2 */
};

/* A volume's description, without its values. */
typedef struct weir_volume {
  size_t struct_size;
  int64_t extent[3];   /* voxels, each 1 to 2^31 - 1; required */
  double spacing[3];   /* world units per voxel, > 0; all 0: 1, 1, 1 */
  double origin[3];    /* world position of the centre of voxel (0, 0, 0) */
  const char* name;    /* name of the grid in the file, at most 255 bytes of UTF-8; NULL: "density" */
  const char* missing; /* the value that stands for "no data", as text ("-9999", "nan"); NULL: none. missing_policy
                          decides what becomes of such voxels */
  int32_t type;        /* WEIR_UINT8 ...; required */
  int32_t reserved;    /* 0 */
} weir_volume;
WEIR_API weir_status weir_volume_init(weir_volume* volume, size_t struct_size);

/* ---- Options of a conversion ----------------------------------------------------------------------------------- */

/* What decides the size of the file. */
enum {
  WEIR_BUDGET_AUTO = 0,      /* rate 8, or the smallest possible file if that is larger; for less than 128^3 voxels
                                at least 40 dB, see docs/budget.md */
  WEIR_BUDGET_RATE = 1,      /* ceil(float32 bytes of the volume / budget) bytes; budget 2^-20 to 2^60 */
  WEIR_BUDGET_SIZE = 2,      /* size bytes, at least 1 */
  WEIR_BUDGET_PSNR = 3,      /* the fewest bytes that reach budget dB */
  WEIR_BUDGET_MAX_ERROR = 4, /* the fewest bytes that keep each voxel's error within budget >= 0, in the values' unit */
  WEIR_BUDGET_LOSSLESS = 5   /* the bytes that every bit of every valid voxel needs */
};
/* How leaves are stored. For an open file it is never AUTO. */
enum {
  WEIR_ENCODING_AUTO = 0,  /* float32 or FPN, whichever has less error at the file's size */
  WEIR_ENCODING_FLOAT = 1, /* 32 bits a voxel */
  WEIR_ENCODING_FPN = 2,   /* 1, 2, 4, 8 or 16 bits a voxel, chosen for each leaf */
  WEIR_ENCODING_FP4 = 3,
  WEIR_ENCODING_FP8 = 4,
  WEIR_ENCODING_FP16 = 5,
  WEIR_ENCODING_PACKED = 6 /* each 8^3 block coded as a whole, for weir's own readers; others see the blocks' means */
};
/* For a packed file: whether its tree holds each block's mean, which programs other than weir read. */
enum {
  WEIR_PREVIEW_AUTO = 0, /* on if it takes at most a tenth of the file */
  WEIR_PREVIEW_ON = 1,
  WEIR_PREVIEW_OFF = 2
};
/* What surveys and encodes packed blocks; all give the same bytes. weir-mpi has only the CPU. */
enum {
  WEIR_BACKEND_AUTO = 0, /* the calling thread's current CUDA device if it answers, the library is built with CUDA
                            and memory is 1 GiB or more; otherwise the CPU */
  WEIR_BACKEND_CPU = 1,
  WEIR_BACKEND_CUDA = 2
};
/* What the budget is spent on: squared error, or the distances of a brick's range to the background. */
enum { WEIR_METRIC_SSE = 0, WEIR_METRIC_FARTHEST = 1, WEIR_METRIC_CLOSEST = 2, WEIR_METRIC_MEDIAN = 3 };
/* What dropped blocks read as. */
enum { WEIR_FILL_MEAN = 0, WEIR_FILL_BACKGROUND = 1 };
/* What the sidecar certifies: the error of the values, or also the error of the gradient by central differences
 * (error.gradient), which reads the volume and the file once more. */
enum { WEIR_CERTIFY_VALUES = 0, WEIR_CERTIFY_GRADIENT = 1 };
/* What becomes of NaN and infinite voxels: the call fails with WEIR_ERROR_INPUT, or they are replaced by the
 * background, or they are kept. */
enum { WEIR_NONFINITE_ERROR = 0, WEIR_NONFINITE_BACKGROUND = 1, WEIR_NONFINITE_KEEP = 2 };
/* What becomes of voxels that hold no data (weir_volume's missing, a file's _FillValue). AUTO: as nonfinite says
 * for NaN; if it keeps NaN, they become NaN. ERROR: the call fails with WEIR_ERROR_INPUT. BACKGROUND: the background
 * replaces them. KEEP: their values count as data. */
enum {
  WEIR_MISSING_POLICY_AUTO = 0,
  WEIR_MISSING_POLICY_ERROR = 1,
  WEIR_MISSING_POLICY_BACKGROUND = 2,
  WEIR_MISSING_POLICY_KEEP = 3
};

typedef struct weir_convert_options {
  size_t struct_size;
  double budget;        /* for WEIR_BUDGET_RATE, _PSNR, _MAX_ERROR */
  uint64_t size;        /* bytes, for WEIR_BUDGET_SIZE */
  uint64_t memory;      /* bytes that weir may take besides what the process has; 0: 512 MiB. Some calls take buffers
                           of their own on top of it; their comments say how much */
  const char* work_dir; /* for temporary files, on a disk; NULL: a hidden directory beside the output */
  /* Callbacks, each optional. weir calls them with `user`, one thread at a time, while the call lasts (for weir_push
   * until its end); the thread may be another than the caller's. They must return soon, and must not call anything
   * with the same handle. */
  /* Float32 bytes that a pass ("survey", "encode" or "certify") has worked on; a pass may begin again. A "check"
   * pass comes before them if a .nvdb file with a sidecar is converted; it counts the file's bytes. */
  void (*progress)(void* user, const char* pass, uint64_t done_bytes, uint64_t total_bytes);
  int (*cancel)(void* user); /* asked several times a second in most passes, and by each slab that comes; if it
                                returns not 0, the call ends with WEIR_INTERRUPTED */
  void (*notice)(void* user, const char* line); /* lines that the user should know and that are not errors */
  void* user;
  int32_t budget_kind; /* WEIR_BUDGET_... */
  int32_t encoding;    /* WEIR_ENCODING_... */
  int32_t metric;      /* WEIR_METRIC_...; with an error budget only WEIR_METRIC_SSE */
  int32_t brick;       /* voxels, granularity of the other metrics: 8, 16 or 32; 0: 8 */
  int32_t fill;        /* WEIR_FILL_... */
  int32_t nonfinite;   /* WEIR_NONFINITE_... */
  int32_t has_background;
  float background;  /* finite; without has_background as with --background auto */
  int32_t overwrite; /* not 0: replace an existing output */
  int32_t threads;   /* 0: one per core */
  /* Since 0.2. */
  int32_t preview;        /* WEIR_PREVIEW_...; for WEIR_ENCODING_PACKED */
  int32_t missing_policy; /* WEIR_MISSING_POLICY_... */
  int32_t at_most;        /* not 0: with WEIR_BUDGET_SIZE or _RATE, a shorter file instead of padding if fewer bytes
                             are enough */
  int32_t backend;        /* WEIR_BACKEND_...; for WEIR_ENCODING_PACKED; AUTO: a device if memory is 1 GiB or more */
  int32_t certify;        /* WEIR_CERTIFY_... */
  int32_t reserved;       /* 0 */
} weir_convert_options;
WEIR_API weir_status weir_convert_options_init(weir_convert_options* options, size_t struct_size);

/* ---- Convert: values in memory, or a file, to a NanoVDB file --------------------------------------------------- */

/* Converts an array. `data` points to voxel (0, 0, 0) of `volume`, at any alignment; the array must not change
 * during the call. Voxel (x, y, z) is at data + x stride[0] + y stride[1] + z stride[2] bytes; strides may be
 * negative or 0. stride NULL: packed, x fastest (C's a[z][y][x], Fortran's a(x, y, z)). options NULL: the defaults.
 * Writes `output` and its sidecar, output.json, both or neither, with the same bytes as the command weir convert for
 * the same values. */
WEIR_API weir_status weir_convert(const weir_volume* volume, const void* data, const int64_t stride[3],
                                  const weir_convert_options* options, const char* output, weir_error* error);

/* A NanoVDB file in memory. Any thread may read it at any time. */
typedef struct weir_buffer weir_buffer;

/* Like weir_convert, but makes the file in memory. Besides options->memory, the process holds the result and, in
 * place of temporary files, about 3 % of the volume's float32 bytes; with an encoding other than FLOAT, up to the
 * result's size more. work_dir must be NULL. The caller frees *buffer with weir_buffer_free. */
WEIR_API weir_status weir_convert_to_memory(const weir_volume* volume, const void* data, const int64_t stride[3],
                                            const weir_convert_options* options, weir_buffer** buffer,
                                            weir_error* error);
/* Returns the file's bytes, aligned to a page, so that a reader may use the grid in place. Valid until
 * weir_buffer_free. */
WEIR_API const void* weir_buffer_data(const weir_buffer* buffer);
WEIR_API uint64_t weir_buffer_size(const weir_buffer* buffer);       /* bytes */
WEIR_API const char* weir_buffer_sidecar(const weir_buffer* buffer); /* JSON text, as it would be beside the file */
WEIR_API void weir_buffer_free(weir_buffer* buffer);

enum { WEIR_ENDIAN_AUTO = 0, WEIR_ENDIAN_LITTLE = 1, WEIR_ENDIAN_BIG = 2 };
enum { WEIR_LEVELS_COMPOSITE = 0, WEIR_LEVELS_SEPARATE = 1 };
enum { WEIR_UPSAMPLE_CONSTANT = 0, WEIR_UPSAMPLE_LINEAR = 1 };
enum { WEIR_MISSING_CHUNKS_FILL = 0, WEIR_MISSING_CHUNKS_ERROR = 1 };

/* What an input file does not tell by itself. */
typedef struct weir_input_options {
  size_t struct_size;
  int64_t extent[3];    /* extent of a raw file; all 0: from its name, NAME_XxYxZ_TYPE.raw */
  uint64_t offset;      /* bytes before a raw file's first value */
  const char* dataset;  /* name of the dataset, in a file with several; NULL: the only one */
  const int64_t* index; /* index_count positions on the axes before the last three; a position below 0 counts from
                           the end */
  size_t index_count;
  const char* missing; /* a "no data" value as in weir_volume, in addition to the file's own */
  double spacing[3];   /* replaces the file's; all 0: the file's */
  double origin[3];    /* replaces the file's if has_origin is set */
  int64_t roi_min[3];  /* only the voxels from roi_min to before roi_max, by the file's own indices, which count from
                          the lowest coordinate even if coordinates fall, and in AMReX from the domain's lower corner.
                          A number below 0 counts from the end as in Python (-3 is the third last), unless the file's
                          indices begin below 0. Both all 0: the whole volume */
  int64_t roi_max[3];
  int32_t type;   /* scalar type of a raw file, WEIR_UINT8 ...; 0: from its name */
  int32_t endian; /* byte order of a raw file, WEIR_ENDIAN_...; AUTO: from its name, otherwise little */
  int32_t has_origin;
  int32_t stack; /* not 0: the path is a pattern, "plane_%05d.raw", for one volume from many files along z */
  /* Since 0.2. */
  const char* component; /* component of an array of vectors: "0", "1", ..., "x", "y", "z" or "magnitude"; NULL: none */
  int64_t ghost[3];      /* layers of ghost cells to leave out at both ends of each axis */
  int32_t level;         /* with has_level, the finest level to read of an AMReX plotfile; 0 is the coarsest */
  int32_t has_level;     /* 0: the finest level of the file */
  int32_t upsample;      /* how cells that only coarser levels cover get values, in an AMReX plotfile:
                            WEIR_UPSAMPLE_... */
  int32_t missing_chunks; /* how chunks that are not stored read, in a Zarr array or an HDF5 dataset:
                             WEIR_MISSING_CHUNKS_... */
  const char* magnitude;  /* "u,v,w": datasets, in place of `dataset`, with the components of vectors; the volume is
                             the vectors' length; NULL: none */
  int32_t levels;         /* of an AMReX plotfile: WEIR_LEVELS_COMPOSITE, one file; WEIR_LEVELS_SEPARATE, a file for
                             each level, "NAME_level_0.nvdb", the finest, and so on, for the output "NAME.nvdb" */
  int32_t reserved;       /* 0 */
} weir_input_options;
WEIR_API weir_status weir_input_options_init(weir_input_options* options, size_t struct_size);

/* Converts a file of any format that weir reads. input_options NULL: the file tells everything. If one of several
 * levels fails, the files of the levels before it remain. */
WEIR_API weir_status weir_convert_file(const char* input, const weir_input_options* input_options,
                                       const weir_convert_options* options, const char* output, weir_error* error);

/* ---- Push: a volume out of a running simulation ---------------------------------------------------------------- */

/* A volume that is handed over in slabs; the values of a slab need not exist after its call. Any threads may push
 * slabs at once; one thread makes the other calls, before and after all slabs. A child that is forked in the
 * meantime must neither use nor free its copy of the handle, because the handle's threads exist only in the parent;
 * the child may call exec or _exit. */
typedef struct weir_push weir_push;

/* Begins `output`. Strings of `volume` and `options` are copied; callbacks and `user` are used until the end. A
 * relative path is resolved by this call. Values are kept in options->memory bytes; values that do not fit are kept
 * compactly in the work directory. Fails with WEIR_ERROR_IO if another push, conversion or process is writing that
 * output. A child that is forked in the meantime shares the output's lock: if its parent is killed, the output stays
 * locked until the child ends or calls exec. The caller frees *push with weir_push_free. */
WEIR_API weir_status weir_push_begin(const weir_volume* volume, const weir_convert_options* options, const char* output,
                                     weir_push** push, weir_error* error);
/* Takes planes z0 to z0 + nz - 1: `data` is voxel (0, 0, z0), `stride` as in weir_convert. The values may be changed
 * after the call. Give each plane once, in any order. After WEIR_ERROR_USAGE (planes outside the volume, or given
 * before) nothing was taken and the push can go on; any other failure ends the push, and every later call returns
 * its status. A full disk is such a failure: the call does not wait until the disk has room. */
WEIR_API weir_status weir_push_slab(weir_push* push, int64_t z0, int64_t nz, const void* data, const int64_t stride[3],
                                    weir_error* error);
/* Writes the file, with the same bytes as weir_convert for the same values, and its sidecar. Fails with
 * WEIR_ERROR_USAGE if planes are missing (they can still be given), or if the file was written already. */
WEIR_API weir_status weir_push_end(weir_push* push, weir_error* error);
/* Frees a push. A push that weir_push_end has not completed leaves no output. */
WEIR_API void weir_push_free(weir_push* push);

/* ---- Load: a NanoVDB file to values ---------------------------------------------------------------------------- */

/* The first grid of a file that weir or another program wrote: float32 or quantised, not compressed. Any threads may
 * make any calls at once, except weir_close. */
typedef struct weir_grid weir_grid;

/* Maps the file and checks everything except the values: no later call reads outside the file, whatever its bytes
 * are. The file must not be truncated while it is open: reading pages that are gone ends a process by SIGBUS. weir
 * itself replaces files and never changes them in place. Fails with WEIR_ERROR_INPUT if the file is missing or not a
 * NanoVDB file, and with WEIR_ERROR_IO if it cannot be read. The caller closes *grid with weir_close. */
WEIR_API weir_status weir_open(const char* path, weir_grid** grid, weir_error* error);
/* Like weir_open, for `bytes` bytes in memory, which are not copied and must not change until weir_close. `sidecar`
 * is JSON text or NULL; a sidecar of another file, or one that cannot be read, certifies nothing and is no error. */
WEIR_API weir_status weir_open_memory(const void* data, uint64_t bytes, const char* sidecar, weir_grid** grid,
                                      weir_error* error);
WEIR_API void weir_close(weir_grid* grid);

typedef struct weir_grid_info {
  size_t struct_size;
  int64_t extent[3];    /* voxels of the domain, the bounding box of active voxels; all 0: there is none */
  int64_t index_min[3]; /* index of the domain's lowest voxel */
  double spacing[3];    /* world units per voxel */
  double origin[3];     /* world position of the centre of voxel (0, 0, 0) */
  double range[2];      /* least and largest decoded active value, as the file says; NaN if it says none */
  double background;    /* value of voxels outside the domain */
  uint64_t file_bytes;
  uint64_t grid_offset; /* bytes before the grid */
  uint64_t grid_bytes;  /* bytes of the grid, padding included */
  uint64_t data_bytes;  /* bytes of the grid without padding at its end: what a copy of it needs */
  /* What the sidecar certifies. If there is no sidecar that can be read, or it belongs to another file, certified,
   * lossless and these figures are 0. */
  double psnr_db;         /* infinite if lossless */
  double mse;             /* mean squared error of the decoded values against the float32 values */
  double max_abs_error;   /* largest error of a voxel */
  double source_range[2]; /* least and largest finite value of the source; NaN if there are none */
  uint64_t nonfinite;     /* NaN and infinite voxels of the source */
  uint64_t missing;       /* voxels without data */
  int32_t certified;
  int32_t lossless; /* over the voxels that are neither nonfinite nor missing */
  int32_t encoding; /* WEIR_ENCODING_... */
  int32_t reserved;
} weir_grid_info;
WEIR_API weir_status weir_grid_info_init(weir_grid_info* info, size_t struct_size);
/* Fills *info; call weir_grid_info_init on it first. */
WEIR_API weir_status weir_get_info(const weir_grid* grid, weir_grid_info* info, weir_error* error);
/* Returns the grid's name, which may be empty. The name and the sidecar's text are valid until weir_close. */
WEIR_API const char* weir_grid_name(const weir_grid* grid);
WEIR_API const char* weir_grid_sidecar(const weir_grid* grid); /* JSON text; NULL if certified is 0 */
/* Returns the grid itself, data_bytes bytes, in the form that NanoVDB's own code takes: aligned to 32 bytes in files
 * that weir wrote and in buffers. The file begins grid_offset bytes before it. Valid until weir_close. */
WEIR_API const void* weir_grid_data(const weir_grid* grid);

/* Returns the value of voxel `index`, the same as NanoVDB's own accessors. Any index is allowed: outside the domain
 * the value is the background, except where the last 8^3 blocks reach beyond the domain's edge and hold a value. */
WEIR_API weir_status weir_value(const weir_grid* grid, const int64_t index[3], float* value, weir_error* error);
/* Reads the voxels from `min` to before `max`, x fastest, into `values`. `count` is the number of floats in `values`
 * and must be exactly the number of voxels; otherwise, or if a corner is beyond +-2^31, fails with WEIR_ERROR_USAGE.
 * Uses only the calling thread. */
WEIR_API weir_status weir_read_box(const weir_grid* grid, const int64_t min[3], const int64_t max[3], float* values,
                                   size_t count, weir_error* error);

enum { WEIR_FILTER_NEAREST = 0, WEIR_FILTER_TRILINEAR = 1 };

/* Returns values at `count` positions (x, y, z), in voxels from the domain's lowest corner: voxel i covers
 * [i, i + 1), its centre is i + 0.5. A world position p is at (p - origin) / spacing - index_min + 0.5. Positions
 * outside are clamped to the domain; the value at a NaN position is NaN. The first call builds a table of 4 bytes per
 * 8^3 voxels, and either decodes all packed blocks or gets a cache of at most 256 MiB for the blocks that are looked
 * up. Fails with WEIR_ERROR_INPUT for a grid without an active voxel. */
WEIR_API weir_status weir_sample(const weir_grid* grid, int32_t filter, const float* positions, size_t count,
                                 float* values, weir_error* error);

#ifdef __cplusplus
}
#endif

/* NOLINTEND */
#endif /* WEIR_H */
