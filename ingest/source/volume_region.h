// The part of a volume that is asked for, before the volume is known: --roi, --ghost.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "format/base/index.h"

namespace weir {

/// Per axis [first, end), half open, by the file's own indices. An end that is left out is the volume's own, and one
/// below 0 counts from the volume's end, unless its indices begin below 0 on that axis, as those of OpenVDB's grids,
/// VTK's WholeExtent and AMReX's domains may: there it is such an index.
struct VolumeRegion {
  std::array<std::optional<std::int64_t>, 3> first;
  std::array<std::optional<std::int64_t>, 3> end;
  std::array<std::int64_t, 3>
      ghost{};  ///< voxels left out at both ends of an axis where `first` and `end` are not given

  VolumeRegion() = default;
  VolumeRegion(const Box& box)  // NOLINT(google-explicit-constructor): a box is a region with all ends given
      : first{box.lo.x, box.lo.y, box.lo.z}, end{box.hi.x, box.hi.y, box.hi.z} {}

  /// The box that it means in a volume of `domain`, which it may reach out of; it may be empty.
  Box in(const Box& domain) const;

  bool operator==(const VolumeRegion&) const = default;
};

}  // namespace weir
