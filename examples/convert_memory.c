/* convert_memory: converts a dense texture in memory, as a renderer has it, to a compressed grid in memory, and
 * samples the grid in place. */
#include <stdio.h>
#include <stdlib.h>
#include <weir.h>

enum { N = 128 };

static int fail(const weir_error* error) {
  fprintf(stderr, "%s\n", error->message);
  return error->status;
}

int main(void) {
  uint16_t* texture = malloc(sizeof *texture * N * N * N);
  if (texture == NULL) return 1;
  for (int z = 0; z < N; ++z)
    for (int y = 0; y < N; ++y)
      for (int x = 0; x < N; ++x) texture[x + N * (y + N * z)] = (uint16_t)(x > N / 2 ? x * y + z : 0);

  weir_error error;
  weir_volume volume;
  weir_volume_init(&volume, sizeof volume);
  volume.extent[0] = volume.extent[1] = volume.extent[2] = N;
  volume.type = WEIR_UINT16;
  weir_convert_options options;
  weir_convert_options_init(&options, sizeof options);
  options.budget_kind = WEIR_BUDGET_MAX_ERROR;
  options.budget = 2;
  weir_buffer* buffer = NULL;
  if (weir_convert_to_memory(&volume, texture, NULL, &options, &buffer, &error) != WEIR_OK) return fail(&error);
  free(texture);

  weir_grid* grid = NULL;
  weir_grid_info info;
  weir_grid_info_init(&info, sizeof info);
  if (weir_open_memory(weir_buffer_data(buffer), weir_buffer_size(buffer), weir_buffer_sidecar(buffer), &grid,
                       &error) != WEIR_OK ||
      weir_get_info(grid, &info, &error) != WEIR_OK) {
    return fail(&error);
  }
  printf("%d bytes of values became %llu, each within %g\n", 2 * N * N * N, (unsigned long long)info.file_bytes,
         info.max_abs_error);

  const float positions[] = {100.5F, 50.5F, 20.5F, 101, 50.5F, 20.5F}; /* a voxel's centre, and half a voxel on */
  float values[2];
  if (weir_sample(grid, WEIR_FILTER_TRILINEAR, positions, 2, values, &error) != WEIR_OK) return fail(&error);
  printf("%g %g\n", (double)values[0], (double)values[1]);
  weir_close(grid);
  weir_buffer_free(buffer);
}
