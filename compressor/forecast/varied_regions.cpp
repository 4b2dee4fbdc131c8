#include "compressor/forecast/varied_regions.h"

#include <algorithm>

#include "compressor/leaf/bounds.h"

namespace weir {

VariedRegions::VariedRegions(const Box& domain)
    : regions_(make_lattice(domain, kLowerDim)), ranges_(static_cast<std::size_t>(regions_.size()), kNoBounds) {}

void VariedRegions::add(const Index3& voxel, const MinMax& values) {
  widen(ranges_[static_cast<std::size_t>(regions_.linear(floor_div(voxel, kLowerDim) - regions_.first))], values);
}

std::uint64_t VariedRegions::count() const {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(ranges_, [](const MinMax& range) { return range.min < range.max; }));
}

}  // namespace weir
