#include "bindings/python/levels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "format/base/error.h"

namespace weir::python {

namespace {

/// Level 0 is read in layers of about this many values; the flag is checked between layers.
constexpr std::int64_t kLayerValues = std::int64_t{1} << 24;

void stop_if(const std::atomic<bool>& cancelled) {
  if (cancelled) throw Error(ErrorKind::interrupted, "interrupted");
}

void read_voxels(VolumeSource& source, const Box& box, std::span<float> values, const std::atomic<bool>& cancelled) {
  const Index3 e = box.extent();
  const std::int64_t depth = std::max<std::int64_t>(kLayerValues / (e.x * e.y) / kLeafDim * kLeafDim, kLeafDim);
  for (std::int64_t z = box.lo.z; z < box.hi.z; z += depth) {
    stop_if(cancelled);
    const Box layer{{box.lo.x, box.lo.y, z}, {box.hi.x, box.hi.y, std::min(z + depth, box.hi.z)}};
    source.read(layer, values.subspan(static_cast<std::size_t>((z - box.lo.z) * e.x * e.y),
                                      static_cast<std::size_t>(layer.voxels())));
  }
}

/// The rows of means of one leaf row or more: the rows in the same 8 x 8 voxels in y and z or, if a cube is larger than
/// that, a single row.
class MeanRows {
 public:
  /// `rows` is a box of values of the level, from the volume's corner.
  MeanRows(VolumeSource& source, int level, const Box& rows)
      : source_(source),
        level_(level),
        edge_(std::int64_t{1} << level),
        rows_(rows),
        sums_(static_cast<std::size_t>(rows.voxels())) {}

  void sum(const std::atomic<bool>& cancelled) {
    const Box domain = source_.info().domain();
    const Box voxels = intersect({domain.lo + rows_.lo * edge_, domain.lo + rows_.hi * edge_}, domain);
    std::vector<float> values;
    for (std::int64_t z = voxels.lo.z; z < voxels.hi.z; z += kLeafDim) {
      for (std::int64_t y = voxels.lo.y; y < voxels.hi.y; y += kLeafDim) {
        stop_if(cancelled);
        const Box part = intersect({{voxels.lo.x, y, z}, {voxels.hi.x, y + kLeafDim, z + kLeafDim}}, voxels);
        values.resize(static_cast<std::size_t>(part.voxels()));
        source_.read(part, values);
        add({part.lo - domain.lo, part.hi - domain.lo}, values.data());
      }
    }
  }

  /// Writes the means of rows_ into `values`, which hold `box`.
  void write(const Box& box, std::span<float> values) const {
    const Index3 extent = source_.info().extent;
    for_each_index(rows_, [&](const Index3& cube) {
      const Index3 reach = min(cube * edge_ + Index3{edge_, edge_, edge_}, extent);
      const auto voxels = static_cast<double>(volume(reach - cube * edge_));
      const double sum = sums_[static_cast<std::size_t>(linear_index(cube - rows_.lo, rows_.extent()))];
      values[static_cast<std::size_t>(linear_index(cube - box.lo, box.extent()))] = static_cast<float>(sum / voxels);
    });
  }

 private:
  // Adds the values of voxels, counted from the volume's corner, x fastest; the first voxel along x begins a cube.
  void add(const Box& voxels, const float* value) {
    for (std::int64_t z = voxels.lo.z; z < voxels.hi.z; ++z) {
      for (std::int64_t y = voxels.lo.y; y < voxels.hi.y; ++y) {
        const Index3 cube{rows_.lo.x, y >> level_, z >> level_};
        double* sum = &sums_[static_cast<std::size_t>(linear_index(cube - rows_.lo, rows_.extent()))];
        for (std::int64_t x = 0; x < voxels.extent().x; ++x) sum[x >> level_] += *value++;
      }
    }
  }

  VolumeSource& source_;
  int level_;
  std::int64_t edge_;
  Box rows_;
  std::vector<double> sums_;
};

}  // namespace

Index3 level_extent(const Index3& extent, int level) {
  const std::int64_t edge = std::int64_t{1} << level;
  return floor_div(extent + Index3{edge - 1, edge - 1, edge - 1}, edge);
}

int level_count(const Index3& extent) {
  int levels = 1;
  while (volume(level_extent(extent, levels - 1)) > 1) ++levels;
  return levels;
}

void read_level(VolumeSource& source, int level, const Box& box, std::span<float> values,
                const std::atomic<bool>& cancelled) {
  if (level == 0) {
    const Index3 lo = source.info().domain().lo;
    read_voxels(source, {lo + box.lo, lo + box.hi}, values, cancelled);
    return;
  }
  const std::int64_t rows = std::max<std::int64_t>(kLeafDim >> level, 1);  // rows along y and z that share leaves
  const NodeLattice groups = make_lattice(Box{{0, box.lo.y, box.lo.z}, {1, box.hi.y, box.hi.z}}, rows);
  tbb::parallel_for(std::int64_t{0}, groups.size(), [&](std::int64_t i) {
    Box part = groups.voxels(groups.position(i));
    part.lo.x = box.lo.x;
    part.hi.x = box.hi.x;
    MeanRows means(source, level, part);
    means.sum(cancelled);
    means.write(box, values);
  });
}

}  // namespace weir::python
