#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "bindings/c/open_grid.h"
#include "bindings/c/status.h"
#include "bindings/c/weir_cuda.h"
#include "format/base/text.h"
#include "gpu/cuda/expand/expanded_grid.h"

struct weir_cuda_grid {
  std::optional<weir::DeviceGrid> grid;
  weir::DeviceBuffer spare;  ///< where there is no grid

  // As it is, or expanded to another type.
  void load(const weir::NvdbFile& file, const std::optional<weir::GridType>& as, cudaStream_t stream) {
    if (grid) spare = std::move(*grid).take_buffer();
    grid.reset();
    grid = as ? weir::load_grid_as(file, *as, std::move(spare), {}, stream)
              : weir::load_grid(file, std::move(spare), {}, stream);
  }
};

using namespace weir;
using namespace weir::c;

namespace {

void load(const weir_grid* grid, const std::optional<GridType>& as, void* stream, weir_cuda_grid** loaded) {
  const NvdbFile* const file = required(grid, "grid")->file();
  if (file == nullptr) throw usage("grid is one in memory; open a file with weir_open, or copy weir_grid_data");
  if (*required(loaded, "loaded") != nullptr) {
    (*loaded)->load(*file, as, static_cast<cudaStream_t>(stream));
    return;
  }
  auto made = std::make_unique<weir_cuda_grid>();
  made->load(*file, as, static_cast<cudaStream_t>(stream));
  *loaded = made.release();
}

GridType type_of(std::string_view name) {
  if (name == "float") return GridType::float32;
  if (name == "fp16") return GridType::fp16;
  throw usage(cat("as is \"", name, "\", it must be float or fp16"));
}

}  // namespace

weir_status weir_cuda_load(const weir_grid* grid, void* stream, weir_cuda_grid** loaded, weir_error* error) {
  return guarded(error, [&] { load(grid, std::nullopt, stream, loaded); });
}

weir_status weir_cuda_load_as(const weir_grid* grid, const char* as, void* stream, weir_cuda_grid** loaded,
                              weir_error* error) {
  return guarded(error, [&] { load(grid, type_of(required(as, "as")), stream, loaded); });
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
