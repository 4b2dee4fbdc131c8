/* A grid on the device holds the bytes of the file's; without a device the load says so. Values on the device become
 * the file that the host's become. */
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

/* Memory of the device where there is one. */
static void* device_copy(const void* values, size_t bytes, int device) {
  void* copy = NULL;
  if (device) {
    CHECK(cudaMalloc(&copy, bytes) == cudaSuccess);
    CHECK(cudaMemcpy(copy, values, bytes, cudaMemcpyHostToDevice) == cudaSuccess);
  } else {
    copy = malloc(bytes);
    memcpy(copy, values, bytes);
  }
  return copy;
}
static void free_copy(void* copy, int device) {
  if (device) {
    CHECK(cudaFree(copy) == cudaSuccess);
  } else {
    free(copy);
  }
}

/* Slabs in any order, in the order of axes z, y, x, with and without device memory for them; and the one call. */
static void pushes(int device) {
  const size_t bytes = sizeof(int16_t) * VOXELS;
  int16_t* const values = malloc(bytes);
  int16_t* const transposed = malloc(bytes);
  for (int z = 0; z < NZ; ++z) {
    for (int y = 0; y < NY; ++y) {
      for (int x = 0; x < NX; ++x) {
        values[x + NX * (y + NY * z)] = (int16_t)pattern(x, y, z);
        transposed[z + NZ * (y + NY * x)] = (int16_t)pattern(x, y, z);
      }
    }
  }
  const weir_volume volume = pattern_volume(WEIR_INT16);
  weir_convert_options options = default_options();
  options.overwrite = 1;
  CHECK_OK(weir_convert(&volume, values, NULL, &options, path_of("whole.nvdb"), &error));
  int16_t* const packed = device_copy(values, bytes, device);
  int16_t* const strided = device_copy(transposed, bytes, device);
  CHECK_OK(weir_convert_device(&volume, packed, NULL, NULL, &options, path_of("pushed.nvdb"), &error));
  CHECK(same_files(path_of("whole.nvdb"), path_of("pushed.nvdb")));

  const int64_t stride[3] = {2 * NZ * NY, 2 * NZ, 2};
  for (uint64_t memory = 0; memory <= 4 * NX * NY; memory += 4 * NX * NY) {
    weir_push* push = NULL;
    CHECK_OK(weir_push_begin(&volume, &options, path_of("pushed.nvdb"), &push, &error));
    CHECK_OK(weir_push_device_memory(push, memory, &error));
    for (int z = NZ - 3; z >= 0; z -= 5) {
      CHECK_OK(weir_push_slab_device(push, z, 3, strided + z, stride, NULL, &error));
    }
    for (int z = NZ - 5; z >= 0; z -= 5) {
      CHECK_OK(weir_push_slab_device(push, z, 2, packed + NX * NY * z, NULL, NULL, &error));
    }
    CHECK_USAGE("memory: a slab of 2 planes from 2 on holds planes 2 to 3, given before; give each plane once",
                weir_push_slab_device(push, 2, 2, packed, NULL, NULL, &error));
    CHECK_OK(weir_push_end(push, &error));
    weir_push_free(push);
    CHECK(same_files(path_of("whole.nvdb"), path_of("pushed.nvdb")));
  }

  weir_push* push = NULL;
  CHECK_USAGE("push is a null pointer", weir_push_slab_device(NULL, 0, 1, packed, NULL, NULL, &error));
  CHECK_USAGE("push is a null pointer", weir_push_device_memory(NULL, 0, &error));
  CHECK_OK(weir_push_begin(&volume, &options, path_of("refused.nvdb"), &push, &error));
  CHECK_USAGE("data is a null pointer", weir_push_slab_device(push, 0, 1, NULL, NULL, NULL, &error));
  if (device) {
    const int64_t odd[3] = {2, 2 * NX + 1, 2 * NX * NY};
    CHECK_USAGE("on a device, the address and the strides of values must be multiples of the 2 bytes of a value",
                weir_push_slab_device(push, 0, 1, packed, odd, NULL, &error));
    CHECK_USAGE("device memory is granted before the first slab of a device, which has come",
                weir_push_device_memory(push, 1 << 20, &error));
  }
  weir_push_free(push);
  CHECK(!exists(path_of("refused.nvdb")));
  free_copy(packed, device);
  free_copy(strided, device);
  free(values);
  free(transposed);
}

static int stays_off;
static void count_stays_off(void* user, const char* line) {
  (void)user;
  if (strstr(line, "the volume does not stay on the device (") != NULL) ++stays_off;
}

/* More device memory is granted than is left: the volume comes to the host, to the same bytes. */
static void push_to_a_full_device(void) {
  enum { EDGE = 256, DEPTH = 512, SLAB = 64 };
  const size_t plane = (size_t)EDGE * EDGE;
  float* const values = malloc(plane * DEPTH * sizeof(float));
  for (size_t i = 0; i < plane * DEPTH; ++i) values[i] = (float)((i * i / 1000) % 1009);
  weir_volume volume = pattern_volume(WEIR_FLOAT32);
  volume.extent[0] = EDGE;
  volume.extent[1] = EDGE;
  volume.extent[2] = DEPTH;
  weir_convert_options options = default_options();
  options.encoding = WEIR_ENCODING_PACKED;
  options.memory = (uint64_t)2 << 30;
  options.backend = WEIR_BACKEND_CPU;
  CHECK_OK(weir_convert(&volume, values, NULL, &options, path_of("host.nvdb"), &error));
  float* const slab = device_copy(values, plane * SLAB * sizeof(float), 1);
  options.backend = WEIR_BACKEND_AUTO;
  options.notice = count_stays_off;
  weir_push* push = NULL;
  CHECK_OK(weir_push_begin(&volume, &options, path_of("device.nvdb"), &push, &error));
  CHECK_OK(weir_push_device_memory(push, plane * DEPTH * sizeof(float), &error));
  enum { MOST = 4096 };
  static void* taken[MOST];
  int count = 0;
  for (size_t bytes = (size_t)1 << 34; bytes >= (size_t)1 << 22; bytes /= 2) {
    while (count < MOST && cudaMalloc(&taken[count], bytes) == cudaSuccess) ++count;
    (void)cudaGetLastError();
  }
  for (int z = 0; z < DEPTH; z += SLAB) {
    CHECK(cudaMemcpy(slab, values + plane * (size_t)z, plane * SLAB * sizeof(float), cudaMemcpyHostToDevice) ==
          cudaSuccess);
    CHECK_OK(weir_push_slab_device(push, z, SLAB, slab, NULL, NULL, &error));
    CHECK(cudaDeviceSynchronize() == cudaSuccess);
  }
  CHECK(stays_off == 1);
  while (count > 0) CHECK(cudaFree(taken[--count]) == cudaSuccess);
  CHECK_OK(weir_push_end(push, &error));
  weir_push_free(push);
  CHECK(same_files(path_of("host.nvdb"), path_of("device.nvdb")));
  free_copy(slab, 1);
  free(values);
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
    CHECK(strncmp(error.message, path_of("a.nvdb"), strlen(path_of("a.nvdb"))) == 0);
    CHECK(strstr(error.message, ": cannot be loaded onto the device: ") != NULL);
    CHECK(strstr(error.message, "; see whether nvidia-smi shows the device") != NULL);
    printf("no device: %s\n", error.message);
  } else {
    /* A program need not clear an error that it has dealt with. */
    void* refused = NULL;
    CHECK(cudaMalloc(&refused, (size_t)1 << 60) == cudaErrorMemoryAllocation);
    CHECK_OK(weir_cuda_load(a, NULL, &loaded, &error));
    expect_on_device(a, loaded);
    CHECK_OK(weir_cuda_load(b, NULL, &loaded, &error)); /* larger */
    expect_on_device(b, loaded);
    CHECK_OK(weir_cuda_load(a, NULL, &loaded, &error));
    expect_on_device(a, loaded);
    weir_cuda_free(loaded);
  }
  pushes(devices > 0);
  if (devices > 0) push_to_a_full_device();
  weir_close(a);
  weir_close(b);
  return finish();
}
