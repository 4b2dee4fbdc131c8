#include "gpu/cuda/runtime/driver_context.h"

#include <cuda_runtime_api.h>

#include <map>
#include <mutex>
#include <utility>

namespace weir {
namespace {

// Functions of the driver, which is installed wherever there is a device, and is not linked. They return 0 for
// success.
using GetCurrent = int (*)(void** context);                          // cuCtxGetCurrent
using SetCurrent = int (*)(void* context);                           // cuCtxSetCurrent
using GetState = int (*)(int device, unsigned* flags, int* active);  // cuDevicePrimaryCtxGetState
using Retain = int (*)(void** context, int device);                  // cuDevicePrimaryCtxRetain
using Release = int (*)(int device);                                 // cuDevicePrimaryCtxRelease
using GetId = int (*)(void* context, unsigned long long* id);        // cuCtxGetId; null: the current context

// Returns null if the driver has no function of this name.
template <class Function>
Function driver_function(const char* name) {
  void* found = nullptr;
  cudaDriverEntryPointQueryResult result{};
#if CUDART_VERSION >= 12050
  const cudaError_t code = cudaGetDriverEntryPointByVersion(name, &found, 12000, cudaEnableDefault, &result);
#else
  const cudaError_t code = cudaGetDriverEntryPoint(name, &found, cudaEnableDefault, &result);
#endif
  if (code == cudaSuccess && result == cudaDriverEntryPointSuccess) return reinterpret_cast<Function>(found);
  cudaGetLastError();
  return nullptr;
}

}  // namespace

void* current_context() {
  static const auto get_current = driver_function<GetCurrent>("cuCtxGetCurrent");
  void* context = nullptr;
  return get_current != nullptr && get_current(&context) == 0 ? context : nullptr;
}

void set_current_context(void* context) {
  static const auto set_current = driver_function<SetCurrent>("cuCtxSetCurrent");
  if (set_current != nullptr) set_current(context);
}

bool has_context(int device) {
  static const auto get_state = driver_function<GetState>("cuDevicePrimaryCtxGetState");
  unsigned flags = 0;
  int active = 0;
  return get_state != nullptr && get_state(device, &flags, &active) == 0 && active != 0;
}

void* primary_context(int device) {
  static const auto retain = driver_function<Retain>("cuDevicePrimaryCtxRetain");
  static const auto release = driver_function<Release>("cuDevicePrimaryCtxRelease");
  static const auto get_id = driver_function<GetId>("cuCtxGetId");
  static std::mutex mutex;
  static std::map<int, unsigned long long> held;  // id of the held context, by device
  if (retain == nullptr || release == nullptr) return nullptr;
  const std::lock_guard lock(mutex);
  void* context = nullptr;
  if (retain(&context, device) != 0) return nullptr;
  unsigned long long id = 0;
  if (get_id == nullptr || get_id(context, &id) != 0) return context;
  if (std::exchange(held[device], id) == id) release(device);  // it was held already
  return context;
}

std::uint64_t current_context_id() {
  static const auto get_id = driver_function<GetId>("cuCtxGetId");
  unsigned long long id = 0;
  return get_id != nullptr && get_id(nullptr, &id) == 0 ? id : 0;
}

}  // namespace weir
