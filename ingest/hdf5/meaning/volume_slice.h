// The three axes of an array that make the volume, and the position on the
// others.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "ingest/hdf5/meaning/axis_places.h"

namespace weir {

inline constexpr std::size_t kVolumeRank = 3;

/// The last three axes of an array at one position on its leading ones. x is the last axis.
struct VolumeSlice {
  Index3 extent;
  std::vector<std::int64_t> index;  ///< one per leading axis, slowest first
  std::array<std::string, 3> labels;
  std::array<double, 3> spacing{1.0, 1.0, 1.0};
  std::array<double, 3> origin{0.0, 0.0, 0.0};
};

/// How many positions --index must give: one per leading axis, or none where each has one element only.
std::size_t leading_axes(std::span<const AxisPlace> axes);

/// The slice of `axes` (three or more, none of extent 0) at `index`. Throws Error(usage), beginning with `where` and
/// saying the axes, where positions are missing, too many or outside.
VolumeSlice volume_slice(std::span<const AxisPlace> axes, const std::vector<std::int64_t>& index,
                         const std::string& where);

}  // namespace weir
