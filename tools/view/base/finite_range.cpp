#include "tools/view/base/finite_range.h"

#include <algorithm>
#include <cmath>

#include "tools/report/read_sidecar.h"

namespace weir {
namespace {

std::optional<MinMax> where_finite(const MinMax& range) {
  const bool finite = std::isfinite(range.min) && std::isfinite(range.max) && range.min <= range.max;
  return finite ? std::optional(range) : std::nullopt;
}

}  // namespace

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
