// The part of a volume that --roi and --ghost ask for. It is given before the volume is known.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "format/base/index.h"

namespace weir {

/// Per axis [first, end), half open, by the file's own indices. An absent end is the volume's own. A value below 0
/// counts from the volume's end, unless the volume's indices begin below 0 on this axis (possible in OpenVDB grids and
/// VTK's WholeExtent): then it is an index. Cells of AMReX count from the domain's lower corner.
struct VolumeRegion {
  std::array<std::optional<std::int64_t>, 3> first;
  std::array<std::optional<std::int64_t>, 3> end;
  std::array<std::int64_t, 3> ghost{};  ///< voxels left out at both ends of an axis if `first` and `end` are absent

  VolumeRegion() = default;
  VolumeRegion(const Box& box)  // NOLINT(google-explicit-constructor): a box is a region with all ends given
      : first{box.lo.x, box.lo.y, box.lo.z}, end{box.hi.x, box.hi.y, box.hi.z} {}

  /// Returns the box that the region means in a volume of `domain`. The box may be empty or reach outside `domain`.
  Box in(const Box& domain) const;

  bool operator==(const VolumeRegion&) const = default;
};

}  // namespace weir
