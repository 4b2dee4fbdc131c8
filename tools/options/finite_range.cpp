#include "tools/options/finite_range.h"

#include <algorithm>
#include <cmath>

#include "format/base/error.h"
#include "tools/report/read_sidecar.h"

namespace weir {
namespace {

std::optional<MinMax> where_finite(const MinMax& range) {
  return has_finite_ends(range) ? std::optional(range) : std::nullopt;
}

}  // namespace

bool has_finite_ends(const MinMax& range) {
  return std::isfinite(range.min) && std::isfinite(range.max) && range.min <= range.max;
}

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
  return where_finite({static_cast<float>(low), static_cast<float>(high)});
}

std::optional<MinMax> finite_range(const MacrocellGrid& cells) {
  MinMax range = kNoBounds;
  for (const MinMax& cell : cells.bounds()) {
    if (std::isfinite(cell.min)) range.min = std::min(range.min, cell.min);
    if (std::isfinite(cell.max)) range.max = std::max(range.max, cell.max);
  }
  return where_finite(range);
}

}  // namespace weir
