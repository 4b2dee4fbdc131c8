#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "bindings/c/open_grid.h"
#include "bindings/c/status.h"
#include "bindings/c/weir_cuda.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "gpu/cuda/expand/expanded_grid.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/runtime/current_device.h"

struct weir_cuda_grid {
  std::optional<weir::DeviceGrid> grid;
  weir::DeviceBuffer spare;  ///< the earlier grid's memory, reused by the next load; only while there is no grid
  int device = 0;            ///< the device of the last load

  // Loads the grid as it is, or expanded to another type.
  void load(const weir::NvdbFile& file, const std::optional<weir::GridType>& as, cudaStream_t stream) {
    device = weir::current_device();
    if (grid) spare = std::move(*grid).take_buffer();
    grid.reset();
    grid = as ? weir::load_grid_as(file, *as, std::move(spare), {}, stream)
              : weir::load_grid(file, std::move(spare), {}, stream);
  }
};

using namespace weir;
using namespace weir::c;

namespace {

// Adds the file and a remedy to errors of the CUDA runtime, which name neither.
void load_into(weir_cuda_grid& to, const NvdbFile& file, const std::optional<GridType>& as, void* stream) {
  try {
    to.load(file, as, static_cast<cudaStream_t>(stream));
  } catch (const DeviceFull& full) {
    throw Error(ErrorKind::io, cat(file.path(), ": its grid of ", format_bytes(file.grid().data_bytes()),
                                   " has no room on the device: ", full.what(),
                                   "; free memory of the device, or make another device current"));
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::io || std::string_view(error.what()).starts_with(file.path())) throw;
    throw Error(ErrorKind::io, cat(file.path(), ": cannot be loaded onto the device: ", error.what(),
                                   "; see whether nvidia-smi shows the device, and what earlier work on it returned"));
  }
}

void load(const weir_grid* grid, const std::optional<GridType>& as, void* stream, weir_cuda_grid** loaded) {
  const NvdbFile* const file = required(grid, "grid")->file();
  if (file == nullptr) throw usage("grid is one in memory; open a file with weir_open, or copy weir_grid_data");
  if (*required(loaded, "loaded") != nullptr) {
    load_into(**loaded, *file, as, stream);
    return;
  }
  auto made = std::make_unique<weir_cuda_grid>();
  load_into(*made, *file, as, stream);
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
void weir_cuda_free(weir_cuda_grid* loaded) {
  if (loaded == nullptr) return;
  free_on(loaded->device, [&] {
    if (cudaDeviceSynchronize() != cudaSuccess) cudaGetLastError();  // waits for kernels that read it, in any stream
    delete loaded;
  });
}
