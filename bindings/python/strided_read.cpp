#include "bindings/python/strided_read.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "format/base/error.h"

namespace weir::python {

namespace {

/// The positions first ... last - 1 of a Stride; one read covers them.
struct StrideGroup {
  std::int64_t first = 0;
  std::int64_t last = 0;

  /// Return the lowest voxel of the group, and one past the highest.
  std::int64_t low(const Stride& stride) const { return std::min(stride.at(first), stride.at(last - 1)); }
  std::int64_t high(const Stride& stride) const { return std::max(stride.at(first), stride.at(last - 1)) + 1; }
};

/// Returns the positions in groups that share a row of leaves. `origin` is the index of the volume's lowest voxel.
std::vector<StrideGroup> groups_of_leaves(const Stride& stride, std::int64_t origin) {
  std::vector<StrideGroup> groups;
  std::int64_t leaf = 0;
  for (std::int64_t i = 0; i < stride.count; ++i) {
    const std::int64_t at = floor_div(origin + stride.at(i), kLeafDim);
    if (groups.empty() || at != leaf) groups.push_back({i, i});
    leaf = at;
    groups.back().last = i + 1;
  }
  return groups;
}

/// Returns the groups along x, y and z.
std::array<std::vector<StrideGroup>, 3> groups_of(const std::array<Stride, 3>& axes, const Index3& origin) {
  const auto& [x, y, z] = axes;
  // Rows of leaves along x are read whole if every leaf of the row has a voxel that is asked for.
  const bool whole_rows = std::abs(x.step) <= kLeafDim;
  return {whole_rows ? std::vector<StrideGroup>{{0, x.count}} : groups_of_leaves(x, origin.x),
          groups_of_leaves(y, origin.y), groups_of_leaves(z, origin.z)};
}

}  // namespace

std::vector<Box> strided_boxes(const std::array<Stride, 3>& axes, const Index3& origin) {
  const auto& [x, y, z] = axes;
  const auto groups = groups_of(axes, origin);
  std::vector<Box> boxes;
  for (const StrideGroup& planes : groups[2]) {
    for (const StrideGroup& rows : groups[1]) {
      for (const StrideGroup& columns : groups[0]) {
        boxes.push_back({origin + Index3{columns.low(x), rows.low(y), planes.low(z)},
                         origin + Index3{columns.high(x), rows.high(y), planes.high(z)}});
      }
    }
  }
  return boxes;
}

void read_strided(VolumeSource& source, const std::array<Stride, 3>& axes, std::span<float> values,
                  const std::atomic<bool>& cancelled) {
  const auto& [x, y, z] = axes;
  const Index3 origin = source.info().domain().lo;
  const Index3 extent{x.count, y.count, z.count};
  const auto groups = groups_of(axes, origin);
  const std::size_t row_count = groups[1].size();
  tbb::parallel_for(std::size_t{0}, row_count * groups[2].size(), [&](std::size_t row) {
    const StrideGroup& rows = groups[1][row % row_count];
    const StrideGroup& planes = groups[2][row / row_count];
    std::vector<float> decoded;
    for (const StrideGroup& columns : groups[0]) {
      if (cancelled) throw Error(ErrorKind::interrupted, "interrupted");
      const Box box{{columns.low(x), rows.low(y), planes.low(z)}, {columns.high(x), rows.high(y), planes.high(z)}};
      decoded.resize(static_cast<std::size_t>(box.voxels()));
      source.read({origin + box.lo, origin + box.hi}, decoded);
      const Box chosen{{columns.first, rows.first, planes.first}, {columns.last, rows.last, planes.last}};
      for_each_index(chosen, [&](const Index3& i) {
        const Index3 voxel{x.at(i.x), y.at(i.y), z.at(i.z)};
        values[static_cast<std::size_t>(linear_index(i, extent))] =
            decoded[static_cast<std::size_t>(linear_index(voxel - box.lo, box.extent()))];
      });
    }
  });
}

}  // namespace weir::python
