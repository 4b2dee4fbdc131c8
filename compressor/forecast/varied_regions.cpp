#include "compressor/forecast/varied_regions.h"

#include <cmath>

#include "format/leaf/bounds.h"

namespace weir {

VariedRegions::VariedRegions(const Box& domain)
    : regions_(make_lattice(domain, kLowerDim)), ranges_(static_cast<std::size_t>(regions_.size()), kNoBounds) {}

void VariedRegions::add(const Index3& voxel, const MinMax& values) {
  widen(ranges_[static_cast<std::size_t>(regions_.linear(floor_div(voxel, kLowerDim) - regions_.first))], values);
}

std::uint64_t VariedRegions::count() const {
  double seen = 0;
  double varied = 0;
  for (const MinMax& range : ranges_) {
    seen += range.min <= range.max ? 1 : 0;
    varied += range.min < range.max ? 1 : 0;
  }
  return seen == 0 ? 0 : static_cast<std::uint64_t>(std::llround(varied / seen * static_cast<double>(ranges_.size())));
}

}  // namespace weir
