#include "tools/options/backend_choice.h"

#include <spdlog/spdlog.h>

#include "format/base/error.h"
#include "format/nanovdb/macrocells.h"
#ifdef WEIR_HAVE_CUDA
#include "gpu/cuda/render/cuda_backend.h"
#include "gpu/cuda/runtime/check.h"
#endif

namespace weir {
namespace {

#ifdef WEIR_HAVE_CUDA
constexpr const char* kNoDevice = "no CUDA device answers";
#else
constexpr const char* kNoDevice = "this build has no CUDA renderer";
#endif

}  // namespace

std::unique_ptr<Backend> make_backend(const BackendChoice& choice, const std::function<void(const Message&)>& notice) {
#ifdef WEIR_HAVE_CUDA
  if (choice.name == "cuda" || (choice.name == "auto" && device_count() > 0)) {
    return make_cuda_backend({.devices = choice.devices,
                              .load = {},
                              .memory = choice.device_memory,
                              .volumes = choice.memory.volumes,
                              .levels = choice.memory.levels});
  }
#else
  if (choice.name == "cuda") {
    throw Error(ErrorKind::usage, compose(option("backend", "cuda"), ": this build has no CUDA renderer; use ",
                                          option("backend", "cpu"), " or auto"));
  }
#endif
  if (choice.device_memory || choice.devices != std::vector{0}) {
    const Message why =
        choice.name == "cpu" ? compose(option("backend", "cpu"), " was chosen") : compose(kNoDevice, ": the CPU draws");
    notice(compose(why, ", and ", option("devices"), " and ", option("device-memory"), " have no effect"));
  }
  return make_cpu_backend(choice.threads, choice.memory);
}

void warn(const Message& notice) { spdlog::warn("{}", notice.text()); }

std::int64_t own_macrocell([[maybe_unused]] const Backend& backend) {
#ifdef WEIR_HAVE_CUDA
  if (backend.name() == "cuda") return kDeviceMacrocell;
#endif
  return kMacrocell;
}

}  // namespace weir
