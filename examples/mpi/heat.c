/* heat OUTPUT_DIR [EDGE] [STEPS]: heat spreads through a cube that the processes of an MPI job hold in layers. Each
 * saved step becomes one file, to which every process hands over its own layers. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "weir_mpi.h"

static void stop_on(weir_status status, const weir_error* error) {
  if (status == WEIR_OK) return;
  fprintf(stderr, "heat: %s\n", error->message);
  MPI_Abort(MPI_COMM_WORLD, status);
}

/* Saves layers z0 to z0 + nz - 1 of the step to DIR/heat_STEP.nvdb. */
static void save(const char* directory, int step, int64_t edge, int64_t z0, int64_t nz, const float* layers) {
  weir_error error;
  char output[4096];
  snprintf(output, sizeof output, "%s/heat_%04d.nvdb", directory, step);
  weir_volume volume;
  weir_volume_init(&volume, sizeof volume);
  volume.extent[0] = volume.extent[1] = volume.extent[2] = edge;
  volume.type = WEIR_FLOAT32;
  weir_mpi_push* push = NULL;
  stop_on(weir_mpi_push_begin(MPI_COMM_WORLD, &volume, NULL, output, &push, &error), &error);
  const int64_t lo[3] = {0, 0, z0};
  const int64_t extent[3] = {edge, edge, nz};
  stop_on(weir_mpi_push_box(push, lo, extent, layers, NULL, &error), &error);
  stop_on(weir_mpi_push_end(push, &error), &error);
  weir_mpi_push_free(push);
}

/* Gets the layers below this process's lowest and above its highest layer from the neighbours. */
static void exchange(float* field, size_t layer, int64_t nz, int below, int above) {
  const int count = (int)layer;
  float* const last = field + (size_t)nz * layer;
  MPI_Sendrecv(last, count, MPI_FLOAT, above, 0, field, count, MPI_FLOAT, below, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  MPI_Sendrecv(field + layer, count, MPI_FLOAT, below, 1, last + layer, count, MPI_FLOAT, above, 1, MPI_COMM_WORLD,
               MPI_STATUS_IGNORE);
}

static void spread(const float* from, float* to, int64_t edge, int64_t z0, int64_t nz) {
  const int64_t row = edge;
  const int64_t layer = edge * edge;
  for (int64_t z = 1; z <= nz; ++z) {
    for (int64_t y = 0; y < edge; ++y) {
      for (int64_t x = 0; x < edge; ++x) {
        const int64_t at = z * layer + y * row + x;
        const int64_t global_z = z0 + z - 1;
        if (x == 0 || y == 0 || global_z == 0 || x == edge - 1 || y == edge - 1 || global_z == edge - 1) {
          to[at] = 0.0F; /* cold walls */
          continue;
        }
        const float around =
            from[at - 1] + from[at + 1] + from[at - row] + from[at + row] + from[at - layer] + from[at + layer];
        to[at] = from[at] + 0.125F * (around - 6.0F * from[at]);
      }
    }
  }
}

int main(int argc, char** argv) {
  int threads = 0;
  int rank = 0;
  int size = 1;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &threads);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  const int64_t edge = argc > 2 ? atoll(argv[2]) : 64;
  const int steps = argc > 3 ? atoi(argv[3]) : 40;
  if (argc < 2 || edge < 3 || edge < size) {
    if (rank == 0)
      fprintf(stderr, "usage: heat OUTPUT_DIR [EDGE] [STEPS], EDGE at least 3 and the number of processes\n");
    MPI_Finalize();
    return 2;
  }
  const int64_t z0 = edge * rank / size; /* borders of layers need not be borders of blocks */
  const int64_t nz = edge * (rank + 1) / size - z0;
  const int below = rank > 0 ? rank - 1 : MPI_PROC_NULL;
  const int above = rank + 1 < size ? rank + 1 : MPI_PROC_NULL;

  const size_t layer = (size_t)(edge * edge);
  float* field = calloc((size_t)(nz + 2) * layer, sizeof(float));
  float* next = calloc((size_t)(nz + 2) * layer, sizeof(float));
  if (field == NULL || next == NULL) MPI_Abort(MPI_COMM_WORLD, 1);
  for (int64_t z = 0; z < nz; ++z) { /* a hot ball */
    for (int64_t y = 0; y < edge; ++y) {
      for (int64_t x = 0; x < edge; ++x) {
        const int64_t dx = 2 * x - edge;
        const int64_t dy = 2 * y - edge;
        const int64_t dz = 2 * (z0 + z) - edge;
        if (4 * (dx * dx + dy * dy + dz * dz) < edge * edge)
          field[(size_t)(z + 1) * layer + (size_t)(y * edge + x)] = 1.0F;
      }
    }
  }
  for (int step = 0; step <= steps; ++step) {
    if (step % 20 == 0) save(argv[1], step, edge, z0, nz, field + layer);
    exchange(field, layer, nz, below, above);
    spread(field, next, edge, z0, nz);
    float* const swapped = field;
    field = next;
    next = swapped;
  }
  free(field);
  free(next);
  MPI_Finalize();
  return 0;
}
