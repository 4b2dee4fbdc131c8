#include "gpu/volume/dense_volume.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "format/nanovdb/macrocells.h"

namespace weir {

namespace {

constexpr MinMax kEmptyRange{kInfinity, -kInfinity};

bool is_number(float v) { return v == v; }

// Returns the bounds of `bounds` and of those of `count` values that counts(v) accepts.
template <class Counts>
MinMax bounds_of(const float* values, std::int64_t count, MinMax bounds, const Counts& counts) {
  for (std::int64_t i = 0; i < count; ++i) {
    const float v = values[i];
    if (!counts(v)) continue;
    bounds.min = std::min(bounds.min, v);
    bounds.max = std::max(bounds.max, v);
  }
  return bounds;
}

MinMax joined(const MinMax& a, const MinMax& b) { return {std::min(a.min, b.min), std::max(a.max, b.max)}; }

}  // namespace

DenseVolume::DenseVolume(const GridFrame& frame, std::unique_ptr<const float[]> values, float background)
    : frame_(frame), values_(std::move(values)), background_(background) {
  range_ = oneapi::tbb::parallel_reduce(
      oneapi::tbb::blocked_range<std::int64_t>(0, frame_.domain.voxels(), 1 << 16), kEmptyRange,
      [&](const auto& part, const MinMax& bounds) {
        return bounds_of(values_.get() + part.begin(), part.end() - part.begin(), bounds, is_finite);
      },
      joined);
  if (!(range_.min <= range_.max)) range_ = {background, background};
}

DenseView DenseVolume::view() const {
  const Index3 e = frame_.domain.extent();
  return {values_.get(),
          {static_cast<std::int32_t>(e.x), static_cast<std::int32_t>(e.y), static_cast<std::int32_t>(e.z)}};
}

MacrocellGrid macrocells_of(const DenseVolume& volume, std::int64_t edge) {
  std::int64_t dim = kMacrocell;
  while (dim < edge) dim *= 2;
  const Box& domain = volume.frame().domain;
  const Index3 extent = domain.extent();
  const NodeLattice lattice = make_lattice(domain, dim);
  const MinMax outside{volume.background(), volume.background()};
  std::vector<MinMax> cells(static_cast<std::size_t>(lattice.size()));
  oneapi::tbb::parallel_for(std::int64_t{0}, lattice.size(), [&](std::int64_t i) {
    const Box apron = grown(lattice.node_box(lattice.position(i)), kMacrocellApron);
    const Box seen = intersect(apron, domain);
    MinMax bounds = domain.contains(apron) ? kEmptyRange : outside;
    for (std::int64_t z = seen.lo.z; z < seen.hi.z; ++z) {
      for (std::int64_t y = seen.lo.y; y < seen.hi.y; ++y) {
        const Index3 at = Index3{seen.lo.x, y, z} - domain.lo;
        bounds = bounds_of(volume.view().values + at.x + extent.x * (at.y + extent.y * at.z), seen.hi.x - seen.lo.x,
                           bounds, is_number);
      }
    }
    cells[static_cast<std::size_t>(i)] = bounds.min <= bounds.max ? bounds : outside;
  });
  return {lattice, std::move(cells)};
}

}  // namespace weir
