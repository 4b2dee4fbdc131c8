#include "bindings/c/open_grid.h"

#include <utility>

#include "bindings/c/status.h"
#include "format/base/error.h"
#include "format/io/file_mapping.h"
#include "format/sidecar/find_sidecar.h"
#include "format/sidecar/is_of.h"

using namespace weir;

weir_grid::weir_grid(const std::string& path) : file_(path) {
  try {
    const FileMapping sidecar(find_sidecar(path), ".json");
    const std::span<const std::byte> bytes = sidecar.bytes();
    take_sidecar({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  } catch (const Error&) {
    // A volume without its sidecar is still a volume: it only has no certificate.
  }
}

weir_grid::weir_grid(std::span<const std::byte> bytes, const char* sidecar) : memory_(NvdbGrid::open(bytes, "memory")) {
  if (sidecar != nullptr) take_sidecar(sidecar);
}

void weir_grid::take_sidecar(std::string text) {
  try {
    Sidecar sidecar = parse_sidecar(text, "sidecar");
    // A sidecar of another volume, for instance after a crash between two renames, certifies nothing either.
    if (!(file_ ? is_of(sidecar, *file_) : is_of(sidecar, grid()))) return;
    sidecar_ = std::move(sidecar);
    text_ = std::move(text);
  } catch (const Error&) {
    // Continues as if there were no sidecar.
  }
}

GridSamples& weir_grid::samples() const {
  const std::scoped_lock lock(mutex_);
  if (!samples_) samples_.emplace(grid());
  return *samples_;
}
