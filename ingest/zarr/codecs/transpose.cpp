#include "ingest/zarr/codecs/transpose.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace weir {
namespace {

constexpr std::size_t kTile = 32;  // values along both axes of a tile: a tile's cache lines stay in the cache

/// A plane of two axes: the chunk's fastest axis, and the axis that is fastest as stored.
struct Plane {
  std::size_t fast_extent;    ///< along the chunk's last axis
  std::size_t stored_extent;  ///< along the axis that is fastest as stored
  std::size_t fast_step;      ///< bytes in `stored` between neighbours along the chunk's last axis
  std::size_t stored_step;    ///< bytes in `values` between neighbours along the axis that is fastest as stored
};

template <std::size_t kBytes>
void copy_plane(const std::byte* stored, std::byte* values, const Plane& plane) {
  for (std::size_t s0 = 0; s0 < plane.stored_extent; s0 += kTile) {
    for (std::size_t f0 = 0; f0 < plane.fast_extent; f0 += kTile) {
      for (std::size_t s = s0; s < std::min(s0 + kTile, plane.stored_extent); ++s) {
        for (std::size_t f = f0; f < std::min(f0 + kTile, plane.fast_extent); ++f) {
          std::memcpy(values + s * plane.stored_step + f * kBytes, stored + s * kBytes + f * plane.fast_step, kBytes);
        }
      }
    }
  }
}

void copy_plane(const std::byte* stored, std::byte* values, const Plane& plane, std::size_t value_bytes) {
  switch (value_bytes) {
    case 1:
      return copy_plane<1>(stored, values, plane);
    case 2:
      return copy_plane<2>(stored, values, plane);
    case 4:
      return copy_plane<4>(stored, values, plane);
    default:
      return copy_plane<8>(stored, values, plane);
  }
}

}  // namespace

void undo_transpose(std::span<const std::byte> stored, std::span<const std::int64_t> extent,
                    std::span<const std::size_t> order, std::size_t value_bytes, std::span<std::byte> values) {
  const std::size_t axes = extent.size();
  const auto extent_of = [&](std::size_t axis) { return static_cast<std::size_t>(extent[axis]); };
  std::vector<std::size_t> stored_step(axes);  // bytes, for each axis of the chunk
  std::vector<std::size_t> value_step(axes);
  std::size_t step = value_bytes;
  for (std::size_t i = axes; i-- > 0; step *= extent_of(order[i])) stored_step[order[i]] = step;
  step = value_bytes;
  for (std::size_t axis = axes; axis-- > 0; step *= extent_of(axis)) value_step[axis] = step;

  const std::size_t fast = axes - 1;
  const std::size_t neighbour = order[axes - 1];
  std::vector<std::size_t> others;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    if (axis != fast && axis != neighbour) others.push_back(axis);
  }
  // If both are the same axis, a plane is one row of values.
  const Plane plane{extent_of(fast), fast == neighbour ? 1 : extent_of(neighbour), stored_step[fast],
                    value_step[neighbour]};
  std::vector<std::size_t> at(others.size());
  while (true) {
    std::size_t from = 0;
    std::size_t to = 0;
    for (std::size_t i = 0; i < others.size(); ++i) {
      from += at[i] * stored_step[others[i]];
      to += at[i] * value_step[others[i]];
    }
    copy_plane(stored.data() + from, values.data() + to, plane, value_bytes);
    std::size_t axis = others.size();
    while (axis > 0 && ++at[axis - 1] == extent_of(others[axis - 1])) at[--axis] = 0;
    if (axis == 0) return;
  }
}

}  // namespace weir
