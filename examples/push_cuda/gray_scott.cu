// gray_scott_cuda EDGE STEPS EVERY DIRECTORY [DEVICE_BYTES]: two substances that react and diffuse (Gray and Scott,
// 1984) in EDGE^3 voxels on a device. For every EVERY-th step, the second substance's concentration becomes
// DIRECTORY/v_NNNN.nvdb, from the buffer in which it was computed, while the next steps run. DEVICE_BYTES of the
// device's memory, if given, hold the step that is being saved: if a whole step fits, it is encoded there and does not
// cross the bus. Prints how long steps take while no step is being saved, and while one is.
#include <weir_cuda.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <string>
#include <utility>

namespace {

void check(cudaError_t code, const char* what) {
  if (code == cudaSuccess) return;
  std::fprintf(stderr, "gray_scott_cuda: %s: %s\n", what, cudaGetErrorString(code));
  std::exit(WEIR_ERROR_IO);
}

void check(weir_status status, const weir_error& error) {
  if (status == WEIR_OK) return;
  std::fprintf(stderr, "%s\n", error.message);
  std::exit(status);
}

// Returns the index of voxel (x, y, z) of a periodic volume of n^3.
__device__ size_t at(int x, int y, int z, int n) {
  const auto wrapped = [n](int i) { return static_cast<size_t>(i < 0 ? i + n : i >= n ? i - n : i); };
  return wrapped(x) + n * (wrapped(y) + n * wrapped(z));
}

__device__ float laplacian(const float* f, int x, int y, int z, int n) {
  return f[at(x - 1, y, z, n)] + f[at(x + 1, y, z, n)] + f[at(x, y - 1, z, n)] + f[at(x, y + 1, z, n)] +
         f[at(x, y, z - 1, n)] + f[at(x, y, z + 1, n)] - 6 * f[at(x, y, z, n)];
}

__global__ void begin_state(float* u, float* v, int n) {
  const int x = blockIdx.x * blockDim.x + threadIdx.x;
  if (x >= n) return;
  const int y = blockIdx.y;
  const int z = blockIdx.z;
  const auto inside = [n](int i) { return i >= n / 2 - 4 && i < n / 2 + 4; };
  const bool seed = inside(x) && inside(y) && inside(z);
  u[at(x, y, z, n)] = seed ? 0.5F : 1;
  v[at(x, y, z, n)] = seed ? 0.25F : 0;
}

__global__ void react(const float* u, const float* v, float* next_u, float* next_v, int n) {
  const int x = blockIdx.x * blockDim.x + threadIdx.x;
  if (x >= n) return;
  const int y = blockIdx.y;
  const int z = blockIdx.z;
  const size_t i = at(x, y, z, n);
  const float reaction = u[i] * v[i] * v[i];
  next_u[i] = u[i] + 0.16F * laplacian(u, x, y, z, n) - reaction + 0.035F * (1 - u[i]);
  next_v[i] = v[i] + 0.08F * laplacian(v, x, y, z, n) + reaction - (0.035F + 0.06F) * v[i];
}

weir_push* begin_push(const std::string& output, int n, uint64_t device_bytes) {
  weir_volume volume;
  weir_volume_init(&volume, sizeof volume);
  for (int64_t& extent : volume.extent) extent = n;
  volume.type = WEIR_FLOAT32;
  volume.name = "v";
  weir_convert_options options;
  weir_convert_options_init(&options, sizeof options);
  options.encoding = WEIR_ENCODING_PACKED;
  options.budget_kind = WEIR_BUDGET_PSNR;  // the fewest bytes that keep 70 dB of a volume that is mostly empty
  options.budget = 70;
  options.memory = 2ULL << 30U;  // from 1 GiB on, the device surveys and encodes
  options.overwrite = 1;
  weir_push* push = nullptr;
  weir_error error;
  check(weir_push_begin(&volume, &options, output.c_str(), &push, &error), error);
  check(weir_push_device_memory(push, device_bytes, &error), error);
  return push;
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// Runs beside the steps: selects, encodes and writes. Returns the seconds since `begun`.
double end_push(weir_push* push, double begun) {
  weir_error error;
  check(weir_push_end(push, &error), error);
  weir_push_free(push);
  return now() - begun;
}

bool saving(const std::future<double>& save) {
  return save.valid() && save.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5 && argc != 6) {
    std::fprintf(stderr, "gray_scott_cuda EDGE STEPS EVERY DIRECTORY [DEVICE_BYTES]\n");
    return WEIR_ERROR_USAGE;
  }
  const int n = std::atoi(argv[1]);
  const int steps = std::atoi(argv[2]);
  const int every = std::atoi(argv[3]);
  const uint64_t device_bytes = argc == 6 ? std::strtoull(argv[5], nullptr, 10) : 0;
  const size_t bytes = sizeof(float) * n * n * n;
  float* u = nullptr;
  float* v = nullptr;
  float* next_u = nullptr;
  float* next_v = nullptr;
  for (float** const field : {&u, &v, &next_u, &next_v}) check(cudaMalloc(field, bytes), "allocating the fields");
  cudaStream_t stream = nullptr;
  check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "making a stream");
  const dim3 threads(128);
  const dim3 blocks((n + 127) / 128, n, n);
  begin_state<<<blocks, threads, 0, stream>>>(u, v, n);

  std::future<double> save;  // of the last saved step
  double held_up = 0;
  double saved_in = 0;
  int saved = 0;
  double seconds[2] = {0, 0};
  int counted[2] = {0, 0};
  for (int step = 1; step <= steps; ++step) {
    const double started = now();
    const bool beside_a_save = saving(save);
    react<<<blocks, threads, 0, stream>>>(u, v, next_u, next_v, n);
    check(cudaGetLastError(), "computing a step");
    if (step % every == 0) {
      if (save.valid()) saved_in += save.get();  // one save at a time
      check(cudaStreamSynchronize(stream), "computing a step");
      const double begun = now();
      char name[32];
      std::snprintf(name, sizeof name, "/v_%04d.nvdb", step);
      weir_push* const push = begin_push(argv[4] + std::string(name), n, device_bytes);
      weir_error error;
      check(weir_push_slab_device(push, 0, n, next_v, nullptr, stream, &error), error);
      held_up += now() - begun;
      ++saved;
      save = std::async(std::launch::async, end_push, push, begun);
    } else {
      check(cudaStreamSynchronize(stream), "computing a step");
      seconds[beside_a_save] += now() - started;
      ++counted[beside_a_save];
    }
    std::swap(u, next_u);
    std::swap(v, next_v);
  }
  if (save.valid()) saved_in += save.get();
  for (const int kind : {0, 1}) {
    if (counted[kind] == 0) continue;
    std::printf("%d steps%s: %.3f ms each\n", counted[kind], kind == 1 ? " while one was saved" : "",
                1000 * seconds[kind] / counted[kind]);
  }
  if (saved > 0) {
    std::printf("%d saved: each held the simulation up for %.1f ms and was a file after %.1f ms\n", saved,
                1000 * held_up / saved, 1000 * saved_in / saved);
  }
  for (float* const field : {u, v, next_u, next_v}) cudaFree(field);
  cudaStreamDestroy(stream);
}
