/* A grid on the device holds the bytes of the file's; without a device the load says so. */
#include "check.h"

#include <cuda_runtime_api.h>

#include "weir_cuda.h"

static weir_error error;

static void expect_on_device(const weir_grid* grid, const weir_cuda_grid* loaded) {
  weir_grid_info info;
  weir_grid_info_init(&info, sizeof info);
  CHECK_OK(weir_get_info(grid, &info, &error));
  CHECK(weir_cuda_bytes(loaded) == info.data_bytes);
  CHECK((uintptr_t)weir_cuda_data(loaded) % 256 == 0 && weir_cuda_seconds(loaded) > 0);
  unsigned char* const copy = malloc(info.data_bytes);
  CHECK(cudaMemcpy(copy, weir_cuda_data(loaded), info.data_bytes, cudaMemcpyDeviceToHost) == cudaSuccess);
  CHECK(memcmp(copy, weir_grid_data(grid), info.data_bytes) == 0);
  free(copy);
}

static void arguments(weir_grid* grid) {
  weir_cuda_grid* loaded = NULL;
  CHECK_USAGE("grid is a null pointer", weir_cuda_load(NULL, NULL, &loaded, &error));
  CHECK_USAGE("loaded is a null pointer", weir_cuda_load(grid, NULL, NULL, &error));
  CHECK_USAGE("as is a null pointer", weir_cuda_load_as(grid, NULL, NULL, &loaded, &error));
  CHECK_USAGE("as is \"fpn\", it must be float or fp16", weir_cuda_load_as(grid, "fpn", NULL, &loaded, &error));
  size_t bytes = 0;
  unsigned char* const file = read_file(path_of("a.nvdb"), &bytes);
  weir_grid* memory = NULL;
  CHECK_OK(weir_open_memory(file, bytes, NULL, &memory, &error));
  CHECK_USAGE("grid is one in memory; open a file with weir_open, or copy weir_grid_data",
              weir_cuda_load(memory, NULL, &loaded, &error));
  weir_close(memory);
  free(file);
  CHECK(loaded == NULL && weir_cuda_data(NULL) == NULL && weir_cuda_bytes(NULL) == 0 && weir_cuda_seconds(NULL) == 0);
  weir_cuda_free(NULL);
}

int main(void) {
  make_directory();
  float* const values = pattern_floats();
  const weir_volume volume = pattern_volume(WEIR_FLOAT32);
  weir_convert_options options = default_options();
  options.budget_kind = WEIR_BUDGET_LOSSLESS;
  CHECK_OK(weir_convert(&volume, values, NULL, NULL, path_of("a.nvdb"), &error));
  CHECK_OK(weir_convert(&volume, values, NULL, &options, path_of("b.nvdb"), &error));
  free(values);
  weir_grid* a = NULL;
  weir_grid* b = NULL;
  CHECK_OK(weir_open(path_of("a.nvdb"), &a, &error));
  CHECK_OK(weir_open(path_of("b.nvdb"), &b, &error));
  arguments(a);

  weir_cuda_grid* loaded = NULL;
  int devices = 0;
  if (cudaGetDeviceCount(&devices) != cudaSuccess || devices == 0) {
    CHECK_STATUS(WEIR_ERROR_IO, weir_cuda_load(a, NULL, &loaded, &error));
    CHECK(loaded == NULL);
    printf("no device: %s\n", error.message);
  } else {
    CHECK_OK(weir_cuda_load(a, NULL, &loaded, &error));
    expect_on_device(a, loaded);
    CHECK_OK(weir_cuda_load(b, NULL, &loaded, &error)); /* larger */
    expect_on_device(b, loaded);
    CHECK_OK(weir_cuda_load(a, NULL, &loaded, &error));
    expect_on_device(a, loaded);
    weir_cuda_free(loaded);
  }
  weir_close(a);
  weir_close(b);
  return finish();
}
