/* Files to values: metadata, single voxels, boxes and samples, of files and of memory, by one thread and by many. */
#include "check.h"

#include <math.h>
#include <pthread.h>

static weir_error error;

static weir_buffer* convert(const weir_volume* volume, const float* values, int32_t budget_kind) {
  weir_buffer* buffer = NULL;
  weir_convert_options options = default_options();
  options.budget_kind = budget_kind;
  CHECK_OK(weir_convert_to_memory(volume, values, NULL, &options, &buffer, &error));
  return buffer;
}

static void metadata(const float* values) {
  weir_volume volume = pattern_volume(WEIR_FLOAT32);
  volume.name = "temperature";
  volume.spacing[0] = 0.5;
  volume.spacing[1] = 1;
  volume.spacing[2] = 2;
  volume.origin[0] = -1;
  CHECK_OK(weir_convert(&volume, values, NULL, NULL, path_of("a.nvdb"), &error));
  weir_grid* grid = NULL;
  CHECK_OK(weir_open(path_of("a.nvdb"), &grid, &error));
  CHECK_TEXT("temperature", weir_grid_name(grid));
  CHECK(strstr(weir_grid_sidecar(grid), "\"weir_sidecar\"") != NULL);
  weir_grid_info info;
  CHECK(weir_grid_info_init(&info, sizeof info) == WEIR_OK);
  CHECK_OK(weir_get_info(grid, &info, &error));
  CHECK(info.struct_size == sizeof info);
  CHECK(info.extent[0] == NX && info.extent[1] == NY && info.extent[2] == NZ);
  CHECK(info.index_min[0] == 0 && info.index_min[1] == 0 && info.index_min[2] == 0);
  CHECK(info.spacing[0] == 0.5 && info.spacing[1] == 1 && info.spacing[2] == 2);
  CHECK(info.origin[0] == -1 && info.origin[1] == 0 && info.origin[2] == 0);
  CHECK(info.background == 0);
  CHECK(info.certified == 1 && info.source_range[0] == 0 && info.source_range[1] == 100);
  CHECK(info.grid_offset % 4096 == 0 && info.grid_offset + info.grid_bytes == info.file_bytes);
  CHECK(info.data_bytes <= info.grid_bytes);
  CHECK(memcmp(weir_grid_data(grid), "NanoVDB", 7) == 0);
  weir_close(grid);

  /* Without its sidecar, and with another file's. */
  CHECK(rename(path_of("a.nvdb.json"), path_of("kept.json")) == 0);
  CHECK_OK(weir_open(path_of("a.nvdb"), &grid, &error));
  CHECK_OK(weir_get_info(grid, &info, &error));
  CHECK(info.certified == 0 && info.psnr_db == 0 && weir_grid_sidecar(grid) == NULL);
  weir_close(grid);
  volume.spacing[0] = 0.25;
  weir_buffer* const other = convert(&volume, values, WEIR_BUDGET_LOSSLESS);
  size_t bytes = 0;
  unsigned char* const file = read_file(path_of("a.nvdb"), &bytes);
  CHECK_OK(weir_open_memory(file, bytes, weir_buffer_sidecar(other), &grid, &error));
  CHECK(weir_grid_sidecar(grid) == NULL);
  weir_close(grid);
  CHECK_OK(weir_open_memory(file, bytes, "{ no sidecar", &grid, &error));
  CHECK(weir_grid_sidecar(grid) == NULL);
  weir_close(grid);
  weir_buffer_free(other);
  free(file);
}

static void exact_values(const weir_grid* grid, const float* values) {
  const int64_t at[3] = {NX - 1, 7, 9};
  const int64_t outside[3] = {-1, INT64_MAX, INT64_MIN};
  float value = -1;
  CHECK_OK(weir_value(grid, at, &value, &error));
  CHECK(value == (float)pattern(NX - 1, 7, 9));
  CHECK_OK(weir_value(grid, outside, &value, &error));
  CHECK(value == 0);

  const int64_t lo[3] = {0, 0, 0};
  const int64_t hi[3] = {NX, NY, NZ};
  float* const all = malloc(sizeof(float) * VOXELS);
  CHECK_OK(weir_read_box(grid, lo, hi, all, VOXELS, &error));
  CHECK(memcmp(all, values, sizeof(float) * VOXELS) == 0);

  const int64_t from[3] = {NX - 11, -3, NZ - 2};
  const int64_t to[3] = {NX + 2, 5, NZ + 1};
  float part[13 * 8 * 3];
  CHECK_OK(weir_read_box(grid, from, to, part, 13 * 8 * 3, &error));
  const float* found = part;
  for (int z = NZ - 2; z < NZ + 1; ++z) {
    for (int y = -3; y < 5; ++y) {
      for (int x = NX - 11; x < NX + 2; ++x) {
        const int beside = x >= NX || z >= NZ; /* what the last blocks hold there is not said */
        CHECK(beside || *found == (y < 0 ? 0.0F : (float)pattern(x, y, z)));
        ++found;
      }
    }
  }
  free(all);
}

static void samples(const weir_grid* grid) {
  const float positions[] = {40.5F, 10.5F, 3.5F, 41, 10.5F, 3.5F, -7, 1e30F, 0, NAN, 1, 1, INFINITY, 20.5F, 5.5F};
  float values[5];
  CHECK_OK(weir_sample(grid, WEIR_FILTER_TRILINEAR, positions, 5, values, &error));
  CHECK(values[0] == (float)pattern(40, 10, 3));
  CHECK(values[1] == 0.5F * (float)pattern(40, 10, 3) + 0.5F * (float)pattern(41, 10, 3));
  CHECK(values[2] == 0);
  CHECK(isnan(values[3]));
  CHECK(values[4] == (float)pattern(NX - 1, 20, 5));
  CHECK_OK(weir_sample(grid, WEIR_FILTER_NEAREST, positions, 5, values, &error));
  CHECK(values[1] == (float)pattern(41, 10, 3));
  CHECK_OK(weir_sample(grid, WEIR_FILTER_NEAREST, NULL, 0, NULL, &error));
}

static void* sample_thread(void* grid) {
  enum { POINTS = 2000 };
  float* const positions = malloc(3 * POINTS * sizeof(float));
  float* const values = malloc(POINTS * sizeof(float));
  for (int i = 0; i < POINTS; ++i) {
    positions[3 * i] = (float)(i % NX) + 0.5F;
    positions[3 * i + 1] = (float)(i % NY) + 0.5F;
    positions[3 * i + 2] = (float)(i % NZ) + 0.5F;
  }
  const weir_status status = weir_sample(grid, WEIR_FILTER_TRILINEAR, positions, POINTS, values, NULL);
  intptr_t wrong = status == WEIR_OK ? 0 : POINTS;
  for (int i = 0; i < POINTS && status == WEIR_OK; ++i) wrong += values[i] != (float)pattern(i % NX, i % NY, i % NZ);
  free(positions);
  free(values);
  return (void*)wrong;
}

/* All of them want the table that the first call builds. */
static void many_threads(const weir_buffer* buffer) {
  weir_grid* grid = NULL;
  CHECK_OK(weir_open_memory(weir_buffer_data(buffer), weir_buffer_size(buffer), NULL, &grid, &error));
  pthread_t threads[4];
  for (int t = 0; t < 4; ++t) CHECK(pthread_create(&threads[t], NULL, sample_thread, grid) == 0);
  for (int t = 0; t < 4; ++t) {
    void* wrong = NULL;
    pthread_join(threads[t], &wrong);
    CHECK(wrong == NULL);
  }
  weir_close(grid);
}

static void what_is_no_grid(const weir_buffer* buffer) {
  weir_grid* grid = NULL;
  CHECK_STATUS(WEIR_ERROR_INPUT, weir_open(path_of("none.nvdb"), &grid, &error));
  CHECK_STATUS(WEIR_ERROR_INPUT, weir_open(directory, &grid, &error));
  CHECK_STATUS(WEIR_ERROR_INPUT, weir_open_memory("no grid", 7, NULL, &grid, &error));
  CHECK_STATUS(WEIR_ERROR_INPUT, weir_open_memory("", 0, NULL, &grid, &error));
  for (uint64_t bytes = 1; bytes < weir_buffer_size(buffer) - 200000; bytes = bytes * 2 + 1) {
    CHECK_STATUS(WEIR_ERROR_INPUT, weir_open_memory(weir_buffer_data(buffer), bytes, NULL, &grid, &error));
  }
  CHECK(grid == NULL);
}

int main(void) {
  make_directory();
  float* const values = pattern_floats();
  const weir_volume volume = pattern_volume(WEIR_FLOAT32);
  metadata(values);
  weir_buffer* const buffer = convert(&volume, values, WEIR_BUDGET_LOSSLESS);
  weir_grid* grid = NULL;
  CHECK_OK(
      weir_open_memory(weir_buffer_data(buffer), weir_buffer_size(buffer), weir_buffer_sidecar(buffer), &grid, &error));
  CHECK(weir_grid_sidecar(grid) != NULL);
  exact_values(grid, values);
  samples(grid);
  weir_close(grid);
  many_threads(buffer);
  what_is_no_grid(buffer);
  weir_buffer_free(buffer);
  free(values);
  return finish();
}
