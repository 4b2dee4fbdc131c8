#include "tools/backend_choice.h"

#include "format/error.h"
#ifdef WEIR_HAVE_CUDA
#include "gpu/cuda/check.h"
#include "gpu/cuda/cuda_backend.h"
#endif

namespace weir {

std::unique_ptr<Backend> make_backend(const std::string& name, int threads) {
#ifdef WEIR_HAVE_CUDA
  if (name == "cuda" || (name == "auto" && device_count() > 0)) return make_cuda_backend({});
#else
  if (name == "cuda") {
    throw Error(ErrorKind::usage, "--backend cuda: this build has no CUDA renderer; use --backend cpu or auto");
  }
#endif
  return make_cpu_backend(threads);
}

}  // namespace weir
