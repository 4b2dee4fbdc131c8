// Defines the functions of the CUDA runtime, for a program that does not link the real one.
#include <cuda_runtime_api.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>
#include <string>

#include "tests/fake_cuda/fake_array.h"
#include "tests/fake_cuda/fake_runtime.h"

using weir::test::FakeRuntime;

namespace {

constexpr int kLeastPriority = 0;

FakeRuntime& runtime() { return FakeRuntime::instance(); }
std::uintptr_t number(const void* address) { return reinterpret_cast<std::uintptr_t>(address); }

cudaError_t allocate(void** memory, std::size_t bytes) {
  *memory = std::aligned_alloc(256, (bytes + 255) / 256 * 256);
  runtime().allocated(number(*memory), bytes);
  return cudaSuccess;
}

cudaError_t release(void* memory) {
  if (memory == nullptr) return cudaSuccess;
  if (!runtime().freed(number(memory))) return cudaErrorInvalidValue;
  std::free(memory);
  return cudaSuccess;
}

void* address_of(int context) { return reinterpret_cast<void*>(std::uintptr_t{1} + static_cast<unsigned>(context)); }

// Functions of the driver. A context's address is its number plus 1.
int cuCtxGetId(void* context, unsigned long long* id) {
  *id = context == nullptr ? runtime().context() : runtime().context_of(static_cast<int>(number(context)) - 1);
  return *id != 0 ? 0 : 1;
}
int cuCtxGetCurrent(void** context) {
  const std::optional<int> current = runtime().current_context();
  *context = current ? address_of(*current) : nullptr;
  return 0;
}
int cuCtxSetCurrent(void* context) {
  runtime().make_current(context == nullptr ? std::nullopt : std::optional(static_cast<int>(number(context)) - 1));
  return 0;
}
int cuDevicePrimaryCtxGetState(int device, unsigned* flags, int* active) {
  *flags = 0;
  *active = runtime().devices_in_use().contains(device) ? 1 : 0;
  return 0;
}

int cuDevicePrimaryCtxRetain(void** context, int device) {
  if (device < 0 || device >= runtime().devices()) return 1;
  runtime().retain(device);
  *context = address_of(device);
  return 0;
}
int cuDevicePrimaryCtxRelease(int device) {
  runtime().release(device);
  return 0;
}

cudaError_t entry_point(const std::string& symbol, void** function, cudaDriverEntryPointQueryResult* result) {
  const std::map<std::string, void*> known{
      {"cuCtxGetId", reinterpret_cast<void*>(&cuCtxGetId)},
      {"cuCtxGetCurrent", reinterpret_cast<void*>(&cuCtxGetCurrent)},
      {"cuCtxSetCurrent", reinterpret_cast<void*>(&cuCtxSetCurrent)},
      {"cuDevicePrimaryCtxGetState", reinterpret_cast<void*>(&cuDevicePrimaryCtxGetState)},
      {"cuDevicePrimaryCtxRetain", reinterpret_cast<void*>(&cuDevicePrimaryCtxRetain)},
      {"cuDevicePrimaryCtxRelease", reinterpret_cast<void*>(&cuDevicePrimaryCtxRelease)},
  };
  const auto found = known.find(symbol);
  *function = found == known.end() ? nullptr : found->second;
  *result = found == known.end() ? cudaDriverEntryPointSymbolNotFound : cudaDriverEntryPointSuccess;
  return cudaSuccess;
}

}  // namespace

// The beginning of a call that works in a context.
#define WEIR_ENTER(function)     \
  runtime().make_some_current(); \
  if (const cudaError_t code = runtime().enter(function); code != cudaSuccess) return code

extern "C" {

cudaError_t cudaGetDeviceCount(int* count) {
  *count = runtime().devices();
  return cudaSuccess;
}
cudaError_t cudaGetDevice(int* device) {
  *device = runtime().current_device();
  return runtime().enter("cudaGetDevice");
}
cudaError_t cudaSetDevice(int device) {
  if (device < 0 || device >= runtime().devices()) return cudaErrorInvalidDevice;
  runtime().choose(device);
  return runtime().enter("cudaSetDevice");
}
cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr attribute, int) {
  WEIR_ENTER("cudaDeviceGetAttribute");
  *value = runtime().attribute(attribute);
  return cudaSuccess;
}
cudaError_t cudaGetLastError() { return runtime().take_last_error(); }
const char* cudaGetErrorName(cudaError_t code) {
  switch (code) {
    case cudaErrorMemoryAllocation:
      return "cudaErrorMemoryAllocation";
    case cudaErrorNotSupported:
      return "cudaErrorNotSupported";
    case cudaErrorIllegalAddress:
      return "cudaErrorIllegalAddress";
    default:
      return "cudaError";
  }
}
const char* cudaGetErrorString(cudaError_t) { return "pretended"; }

cudaError_t cudaMallocAsync(void** memory, std::size_t bytes, cudaStream_t) {
  runtime().make_some_current();
  if (const cudaError_t code = runtime().enter_allocation("cudaMallocAsync", bytes); code != cudaSuccess) return code;
  return allocate(memory, bytes);
}
cudaError_t cudaFreeAsync(void* memory, cudaStream_t) {
  WEIR_ENTER("cudaFreeAsync");
  return release(memory);
}
cudaError_t cudaFree(void* memory) {
  WEIR_ENTER("cudaFree");
  return release(memory);
}
cudaError_t cudaHostAlloc(void** memory, std::size_t bytes, unsigned) {
  WEIR_ENTER("cudaHostAlloc");
  WEIR_ENTER("allocation");
  return allocate(memory, bytes);
}
cudaError_t cudaFreeHost(void* memory) {
  WEIR_ENTER("cudaFreeHost");
  return release(memory);
}
cudaError_t cudaMemGetInfo(std::size_t* free, std::size_t* total) {
  runtime().make_some_current();
  *total = runtime().capacity();
  *free = *total - std::min<std::size_t>(*total, runtime().allocated_bytes());
  return cudaSuccess;
}
cudaError_t cudaHostRegister(void* memory, std::size_t bytes, unsigned flags) {
  WEIR_ENTER("cudaHostRegister");
  return runtime().register_range(number(memory), bytes, flags);
}
cudaError_t cudaHostUnregister(void* memory) {
  WEIR_ENTER("cudaHostUnregister");
  return runtime().unregister_range(number(memory));
}
cudaError_t cudaHostGetDevicePointer(void** device, void* host, unsigned) {
  WEIR_ENTER("cudaHostGetDevicePointer");
  *device = host;
  return cudaSuccess;
}
cudaError_t cudaMemcpy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind) {
  WEIR_ENTER("cudaMemcpy");
  std::memcpy(to, from, bytes);
  return cudaSuccess;
}
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind, cudaStream_t stream) {
  WEIR_ENTER("cudaMemcpyAsync");
  if (const cudaError_t code = runtime().enter_stream(stream); code != cudaSuccess) return code;
  runtime().copy_begins(number(from));
  std::memcpy(to, from, bytes);
  return cudaSuccess;
}
cudaError_t cudaMemcpy3DAsync(const cudaMemcpy3DParms* parts, cudaStream_t) {
  WEIR_ENTER("cudaMemcpy3DAsync");
  if (parts->dstArray != nullptr) {  // fills all of an array from the same number of texels in memory
    auto& array = *reinterpret_cast<weir::test::FakeArray*>(parts->dstArray);
    std::memcpy(&array + 1, parts->srcPtr.ptr, array.bytes());
    return cudaSuccess;
  }
  const auto row = [](const cudaPitchedPtr& all, const cudaPos& first, std::size_t y, std::size_t z) {
    return static_cast<char*>(all.ptr) + first.x + all.pitch * (first.y + y + all.ysize * (first.z + z));
  };
  for (std::size_t z = 0; z < parts->extent.depth; ++z) {
    for (std::size_t y = 0; y < parts->extent.height; ++y) {
      std::memcpy(row(parts->dstPtr, parts->dstPos, y, z), row(parts->srcPtr, parts->srcPos, y, z),
                  parts->extent.width);
    }
  }
  return cudaSuccess;
}
cudaError_t cudaMemset(void* memory, int value, std::size_t bytes) {
  WEIR_ENTER("cudaMemset");
  std::memset(memory, value, bytes);
  return cudaSuccess;
}
cudaError_t cudaMemsetAsync(void* memory, int value, std::size_t bytes, cudaStream_t) {
  WEIR_ENTER("cudaMemsetAsync");
  std::memset(memory, value, bytes);
  return cudaSuccess;
}
cudaError_t cudaEventCreateWithFlags(cudaEvent_t* event, unsigned) {
  WEIR_ENTER("cudaEventCreateWithFlags");
  WEIR_ENTER("allocation");
  void* memory = nullptr;
  allocate(&memory, 1);
  *event = static_cast<cudaEvent_t>(memory);
  return cudaSuccess;
}
cudaError_t cudaEventDestroy(cudaEvent_t event) {
  runtime().make_some_current();
  return release(event);
}
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t) {
  WEIR_ENTER("cudaEventRecord");
  runtime().event_recorded(number(event));
  return cudaSuccess;
}
cudaError_t cudaEventSynchronize(cudaEvent_t event) {
  WEIR_ENTER("cudaEventSynchronize");
  runtime().event_awaited(number(event));
  return cudaSuccess;
}
cudaError_t cudaEventQuery(cudaEvent_t event) {
  WEIR_ENTER("cudaEventQuery");
  runtime().event_awaited(number(event));
  return cudaSuccess;
}
cudaError_t cudaStreamCreate(cudaStream_t* stream) {
  *stream = runtime().make_stream();
  return cudaSuccess;
}
cudaError_t cudaStreamCreateWithPriority(cudaStream_t* stream, unsigned, int priority) {
  WEIR_ENTER("cudaStreamCreateWithPriority");
  return priority == kLeastPriority ? cudaStreamCreate(stream) : cudaErrorInvalidValue;
}
cudaError_t cudaDeviceGetStreamPriorityRange(int* least, int* greatest) {
  *least = kLeastPriority;
  *greatest = -5;
  return cudaSuccess;
}
cudaError_t cudaPointerGetAttributes(cudaPointerAttributes* attributes, const void* address) {
  WEIR_ENTER("cudaPointerGetAttributes");
  *attributes = {};
  attributes->type = runtime().holds(number(address)) ? cudaMemoryTypeDevice : cudaMemoryTypeUnregistered;
  return cudaSuccess;
}
#if CUDART_VERSION >= 12050
cudaError_t cudaGetDriverEntryPointByVersion(const char* symbol, void** function, unsigned, unsigned long long,
                                             cudaDriverEntryPointQueryResult* result) {
  return entry_point(symbol, function, result);
}
#else
cudaError_t cudaGetDriverEntryPoint(const char* symbol, void** function, unsigned long long,
                                    cudaDriverEntryPointQueryResult* result) {
  return entry_point(symbol, function, result);
}
#endif
cudaError_t cudaDeviceSynchronize() {
  WEIR_ENTER("cudaDeviceSynchronize");
  return cudaSuccess;
}
// Freed memory is free at once, because the pool keeps nothing.
cudaError_t cudaDeviceGetDefaultMemPool(cudaMemPool_t* pool, int) {
  *pool = nullptr;
  return cudaSuccess;
}
cudaError_t cudaMemPoolSetAttribute(cudaMemPool_t, cudaMemPoolAttr, void*) { return cudaSuccess; }
cudaError_t cudaMemPoolGetAttribute(cudaMemPool_t, cudaMemPoolAttr, void* value) {
  const std::uint64_t bytes = runtime().allocated_bytes();
  std::memcpy(value, &bytes, sizeof bytes);
  return cudaSuccess;
}
cudaError_t cudaMemPoolTrimTo(cudaMemPool_t, std::size_t) { return cudaSuccess; }
cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned) {
  WEIR_ENTER("allocation");
  return cudaStreamCreate(stream);
}
cudaError_t cudaStreamWaitEvent(cudaStream_t, cudaEvent_t, unsigned) {
  runtime().make_some_current();
  return cudaSuccess;
}
cudaError_t cudaMemcpyPeer(void* to, int, const void* from, int, std::size_t bytes) {
  WEIR_ENTER("cudaMemcpyPeer");
  std::memcpy(to, from, bytes);
  return cudaSuccess;
}
cudaError_t cudaStreamDestroy(cudaStream_t) {
  runtime().make_some_current();
  return cudaSuccess;
}
cudaError_t cudaStreamSynchronize(cudaStream_t stream) {
  WEIR_ENTER("cudaStreamSynchronize");
  runtime().name_stream(stream);
  runtime().stream_awaited();
  return cudaSuccess;
}

}  // extern "C"
