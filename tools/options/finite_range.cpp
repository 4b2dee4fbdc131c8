#include "tools/options/finite_range.h"

#include "format/base/error.h"
#include "format/sidecar/read_sidecar.h"

namespace weir {
std::optional<MinMax> known_range(const NvdbFile& file) {
  const MinMax stored{file.grid().value_min(), file.grid().value_max()};
  if (has_finite_ends(stored)) return stored;
  try {
    return certified_range(file);
  } catch (const Error&) {  // a sidecar that cannot be read certifies nothing
    return std::nullopt;
  }
}

std::optional<MinMax> certified_range(const NvdbFile& file) {
  const std::optional<Sidecar> sidecar = own_sidecar(file);
  if (!sidecar) return std::nullopt;
  const auto [low, high] = sidecar->value_range;
  const MinMax range{static_cast<float>(low), static_cast<float>(high)};
  return has_finite_ends(range) ? std::optional(range) : std::nullopt;
}

}  // namespace weir
