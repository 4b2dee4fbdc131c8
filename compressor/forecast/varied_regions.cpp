#include "compressor/forecast/varied_regions.h"

#include <algorithm>
#include <cmath>

#include "format/leaf/bounds.h"

namespace weir {

VariedRegions::VariedRegions(const Box& domain)
    : regions_(make_lattice(domain, kLowerDim)),
      ranges_(static_cast<std::size_t>(regions_.size()), kNoBounds),
      seen_(ranges_.size()) {}

std::size_t VariedRegions::region_of(const Index3& voxel) const {
  return static_cast<std::size_t>(regions_.linear(floor_div(voxel, kLowerDim) - regions_.first));
}

void VariedRegions::add(const Index3& voxel, const MinMax& values) {
  const std::size_t region = region_of(voxel);
  widen(ranges_[region], values);
  if (values.min <= values.max) seen_[region] = 1;
}

void VariedRegions::add_hidden(const Index3& voxel) { seen_[region_of(voxel)] = 1; }

std::uint64_t VariedRegions::count() const {
  const auto seen = static_cast<double>(std::ranges::count(seen_, 1));
  double varied = 0;
  for (const MinMax& range : ranges_) varied += range.min < range.max ? 1 : 0;
  return seen == 0 ? 0 : static_cast<std::uint64_t>(std::llround(varied / seen * static_cast<double>(ranges_.size())));
}

}  // namespace weir
