/* gray_scott EDGE STEPS EVERY DIRECTORY: two substances that react and diffuse (Gray and Scott, 1984) in EDGE^3
 * voxels. For every EVERY-th step, the second substance's concentration becomes DIRECTORY/v_NNNN.nvdb, plane by
 * plane, while the step is computed: it keeps no copy and writes no raw file. */
#include <stdio.h>
#include <stdlib.h>
#include <weir.h>

static int n;
static size_t at(int x, int y, int z) { /* periodic */
  return (size_t)((x + n) % n) + (size_t)n * ((size_t)((y + n) % n) + (size_t)n * (size_t)((z + n) % n));
}
static float laplacian(const float* f, int x, int y, int z) {
  return f[at(x - 1, y, z)] + f[at(x + 1, y, z)] + f[at(x, y - 1, z)] + f[at(x, y + 1, z)] + f[at(x, y, z - 1)] +
         f[at(x, y, z + 1)] - 6 * f[at(x, y, z)];
}

static void check(weir_status status, const weir_error* error) {
  if (status == WEIR_OK) return;
  fprintf(stderr, "%s\n", error->message);
  exit(status);
}

static weir_push* begin(const char* directory, int step) {
  char output[4096];
  snprintf(output, sizeof output, "%s/v_%04d.nvdb", directory, step);
  weir_volume volume;
  weir_volume_init(&volume, sizeof volume);
  for (int axis = 0; axis < 3; ++axis) volume.extent[axis] = n;
  volume.type = WEIR_FLOAT32;
  volume.name = "v";
  weir_convert_options options;
  weir_convert_options_init(&options, sizeof options);
  options.budget_kind = WEIR_BUDGET_PSNR; /* the fewest bytes that keep 50 dB */
  options.budget = 50;
  options.overwrite = 1;
  weir_push* push = NULL;
  weir_error error;
  check(weir_push_begin(&volume, &options, output, &push, &error), &error);
  return push;
}

int main(int argc, char** argv) {
  if (argc != 5) return fprintf(stderr, "gray_scott EDGE STEPS EVERY DIRECTORY\n"), WEIR_ERROR_USAGE;
  n = atoi(argv[1]);
  const int steps = atoi(argv[2]), every = atoi(argv[3]);
  const size_t voxels = (size_t)n * (size_t)n * (size_t)n;
  float *u = malloc(voxels * sizeof *u), *next_u = malloc(voxels * sizeof *u);
  float *v = malloc(voxels * sizeof *v), *next_v = malloc(voxels * sizeof *v);
  if (u == NULL || next_u == NULL || v == NULL || next_v == NULL) return fprintf(stderr, "out of memory\n"), 1;
  for (size_t i = 0; i < voxels; ++i) u[i] = 1, v[i] = 0;
  for (int z = n / 2 - 4; z < n / 2 + 4; ++z)
    for (int y = n / 2 - 4; y < n / 2 + 4; ++y)
      for (int x = n / 2 - 4; x < n / 2 + 4; ++x) u[at(x, y, z)] = 0.5F, v[at(x, y, z)] = 0.25F;

  weir_error error;
  for (int step = 1; step <= steps; ++step) {
    weir_push* const push = step % every == 0 ? begin(argv[4], step) : NULL;
    for (int z = 0; z < n; ++z) {
      for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
          const size_t i = at(x, y, z);
          const float reaction = u[i] * v[i] * v[i];
          next_u[i] = u[i] + 0.16F * laplacian(u, x, y, z) - reaction + 0.035F * (1 - u[i]);
          next_v[i] = v[i] + 0.08F * laplacian(v, x, y, z) + reaction - (0.035F + 0.06F) * v[i];
        }
      }
      if (push != NULL) check(weir_push_slab(push, z, 1, next_v + at(0, 0, z), NULL, &error), &error);
    }
    if (push != NULL) check(weir_push_end(push, &error), &error);
    weir_push_free(push);
    float *const old_u = u, *const old_v = v;
    u = next_u, v = next_v, next_u = old_u, next_v = old_v;
  }
  free(u), free(v), free(next_u), free(next_v);
}
