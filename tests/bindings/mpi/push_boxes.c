/* push_boxes VOLUME.raw X Y Z TYPE OUT.nvdb KIND BUDGET MODE: hands a raw volume over in boxes, by all processes of the
 * job, and prints status and message of the end. MODE: all; or, what must be refused: missing, twice, outside, null,
 * differing, elsewhere, memory, options; or, by the process that has the last box: cancelled, or strides, which are
 * wrong at first. */
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/mpi/weir_mpi.h"

static const size_t kBytes[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};

static void* read_all(const char* path, size_t bytes) {
  FILE* file = fopen(path, "rb");
  void* values = malloc(bytes);
  if (file == NULL || values == NULL || fread(values, 1, bytes, file) != bytes) {
    fprintf(stderr, "%s: cannot be read\n", path);
    MPI_Abort(MPI_COMM_WORLD, 9);
  }
  fclose(file);
  return values;
}

static int cancel(void* user) { return *(int*)user; }

/* The volume is cut into 2 x 3 x cuts boxes, at places that are no borders of blocks; box b is rank b % size's. */
int main(int argc, char** argv) {
  int threads = 0;
  int rank = 0;
  int size = 1;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &threads);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  if (argc != 10) MPI_Abort(MPI_COMM_WORLD, 9);
  const char* const mode = argv[9];

  weir_volume volume;
  weir_volume_init(&volume, sizeof volume);
  for (int i = 0; i < 3; ++i) volume.extent[i] = atoll(argv[2 + i]);
  volume.type = atoi(argv[5]);
  weir_convert_options options;
  weir_convert_options_init(&options, sizeof options);
  options.budget_kind = atoi(argv[7]);
  options.budget = atof(argv[8]);
  options.nonfinite = WEIR_NONFINITE_BACKGROUND;
  int cancelled = 0;
  options.cancel = cancel;
  options.user = &cancelled;
  const size_t value = kBytes[volume.type];
  const int64_t stride[3] = {(int64_t)value, (int64_t)value * volume.extent[0],
                             (int64_t)value * volume.extent[0] * volume.extent[1]};
  char* const values = read_all(argv[1], value * (size_t)(volume.extent[0] * volume.extent[1] * volume.extent[2]));

  if (rank == size - 1 && strcmp(mode, "differing") == 0) volume.extent[2] -= 1;
  if (rank == size - 1 && strcmp(mode, "elsewhere") == 0) volume.origin[0] = 100;
  if (rank == size - 1 && strcmp(mode, "memory") == 0) options.memory = 1;
  if (rank == size - 1 && strcmp(mode, "options") == 0) options.struct_size = 0;
  weir_error error;
  weir_mpi_push* push = NULL;
  weir_status status = weir_mpi_push_begin(MPI_COMM_WORLD, &volume, &options, argv[6], &push, &error);
  const int64_t cuts[3] = {2, 3, 4};
  for (int64_t b = 0; status == WEIR_OK && b < cuts[0] * cuts[1] * cuts[2]; ++b) {
    const int64_t at[3] = {b % cuts[0], b / cuts[0] % cuts[1], b / (cuts[0] * cuts[1])};
    int64_t lo[3];
    int64_t extent[3];
    const char* first = values;
    int empty = 0;
    for (int i = 0; i < 3; ++i) {
      lo[i] = volume.extent[i] * at[i] / cuts[i];
      extent[i] = volume.extent[i] * (at[i] + 1) / cuts[i] - lo[i];
      first += lo[i] * stride[i];
      empty = empty || extent[i] == 0;
    }
    const int last = b + 1 == cuts[0] * cuts[1] * cuts[2];
    if (empty || (last && strcmp(mode, "missing") == 0)) continue;
    if (b % size != rank && !(last && strcmp(mode, "twice") == 0)) continue;
    if (last && strcmp(mode, "outside") == 0) lo[2] += 1;
    if (last && strcmp(mode, "strides") == 0) {
      const int64_t far_away[3] = {stride[0], stride[1], LLONG_MAX / 4};
      status = weir_mpi_push_box(push, lo, extent, first, far_away, &error);
      if (status != WEIR_OK) printf("box: %d %s\n", (int)status, error.message);
    }
    cancelled = last && strcmp(mode, "cancelled") == 0;
    status = weir_mpi_push_box(push, lo, extent, last && strcmp(mode, "null") == 0 ? NULL : first, stride, &error);
    cancelled = 0;
    if (status != WEIR_OK) printf("box: %d %s\n", (int)status, error.message);
  }
  if (push != NULL) {
    status = weir_mpi_push_end(push, &error);
    if (rank == 0) printf("end: %d %s\n", (int)status, error.message);
    if (status == WEIR_OK && rank == 0 &&
        weir_mpi_push_box(push, volume.extent, volume.extent, values, NULL, &error) != WEIR_OK) {
      printf("after: %s\n", error.message);
    }
  } else if (rank == 0) {
    printf("begin: %d %s\n", (int)status, error.message);
  }
  weir_mpi_push_free(push);
  free(values);
  MPI_Finalize();
  return 0;
}
