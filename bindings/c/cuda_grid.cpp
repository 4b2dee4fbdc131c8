#include <memory>
#include <optional>
#include <utility>

#include "bindings/c/open_grid.h"
#include "bindings/c/status.h"
#include "bindings/c/weir_cuda.h"
#include "gpu/cuda/grid_loader.h"

struct weir_cuda_grid {
  std::optional<weir::DeviceGrid> grid;
  weir::DeviceBuffer spare;  ///< where there is no grid

  void load(const weir::NvdbFile& file, cudaStream_t stream) {
    if (grid) spare = std::move(*grid).take_buffer();
    grid.reset();
    grid = weir::load_grid(file, std::move(spare), {}, stream);
  }
};

using namespace weir;
using namespace weir::c;

weir_status weir_cuda_load(const weir_grid* grid, void* stream, weir_cuda_grid** loaded, weir_error* error) {
  return guarded(error, [&] {
    const NvdbFile* const file = required(grid, "grid")->file();
    if (file == nullptr) throw usage("grid is one in memory; open a file with weir_open, or copy weir_grid_data");
    if (*required(loaded, "loaded") != nullptr) {
      (*loaded)->load(*file, static_cast<cudaStream_t>(stream));
      return;
    }
    auto made = std::make_unique<weir_cuda_grid>();
    made->load(*file, static_cast<cudaStream_t>(stream));
    *loaded = made.release();
  });
}

const void* weir_cuda_data(const weir_cuda_grid* loaded) {
  return loaded == nullptr || !loaded->grid ? nullptr : loaded->grid->data();
}
uint64_t weir_cuda_bytes(const weir_cuda_grid* loaded) {
  return loaded == nullptr || !loaded->grid ? 0 : loaded->grid->bytes();
}
double weir_cuda_seconds(const weir_cuda_grid* loaded) {
  return loaded == nullptr || !loaded->grid ? 0 : loaded->grid->report().seconds;
}
void weir_cuda_free(weir_cuda_grid* loaded) { delete loaded; }
