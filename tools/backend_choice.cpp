#include "tools/backend_choice.h"

#include "format/error.h"

namespace weir {

std::unique_ptr<Backend> make_backend(const std::string& name, int threads) {
  if (name == "cuda") {
    throw Error(ErrorKind::usage, "--backend cuda: this build has no CUDA renderer; use --backend cpu or auto");
  }
  return make_cpu_backend(threads);
}

}  // namespace weir
