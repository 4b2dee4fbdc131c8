#include "ingest/source/volume_region.h"

#include <cstddef>

namespace weir {

Box VolumeRegion::in(const Box& domain) const {
  const std::array<std::int64_t, 3> lo{domain.lo.x, domain.lo.y, domain.lo.z};
  const std::array<std::int64_t, 3> hi{domain.hi.x, domain.hi.y, domain.hi.z};
  const auto placed = [&](const std::optional<std::int64_t>& given, std::size_t axis, std::int64_t own) {
    if (!given) return own;
    return *given < 0 && lo.at(axis) >= 0 ? hi.at(axis) + *given : *given;
  };
  std::array<std::int64_t, 3> from{};
  std::array<std::int64_t, 3> to{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    from.at(axis) = placed(first.at(axis), axis, lo.at(axis) + ghost.at(axis));
    to.at(axis) = placed(end.at(axis), axis, hi.at(axis) - ghost.at(axis));
  }
  return {{from[0], from[1], from[2]}, {to[0], to[1], to[2]}};
}

}  // namespace weir
