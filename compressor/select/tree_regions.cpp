#include "compressor/select/tree_regions.h"

#include <algorithm>

namespace weir {

double TileSums::sse_about(float fill) const {
  const double shift = static_cast<double>(mean) - static_cast<double>(fill);
  return std::max(0.0, sse + 2.0 * shift * residual + static_cast<double>(finite) * shift * shift);
}

double TileSums::max_abs_about(float fill) const {
  if (finite == 0) return 0;
  return std::max(static_cast<double>(fill) - static_cast<double>(min),
                  static_cast<double>(max) - static_cast<double>(fill));
}

TreeRegions::TreeRegions(const Box& domain)
    : leaves(make_lattice(domain, kLeafDim)),
      region_lattice(make_lattice(domain, kLowerDim)),
      upper_lattice(make_lattice(domain, kUpperDim)),
      regions(static_cast<std::size_t>(region_lattice.size())),
      uppers(static_cast<std::size_t>(upper_lattice.size())) {}

Box TreeRegions::leaf_box(std::int64_t region) const {
  return leaves.positions(region_lattice.voxels(region_lattice.position(region)));
}

std::int64_t TreeRegions::upper_of(std::int64_t region) const {
  const Index3 node = region_lattice.first + region_lattice.position(region);
  return upper_lattice.linear(floor_div(node, kUpperLowers) - upper_lattice.first);
}

Index3 TreeRegions::entry_of(std::int64_t region) const {
  const Index3 node = region_lattice.first + region_lattice.position(region);
  return node - floor_div(node, kUpperLowers) * kUpperLowers;
}

Box TreeRegions::region_box(std::int64_t upper) const {
  const Index3 first = (upper_lattice.first + upper_lattice.position(upper)) * kUpperLowers - region_lattice.first;
  return intersect({first, first + Index3{kUpperLowers, kUpperLowers, kUpperLowers}},
                   {{0, 0, 0}, region_lattice.count});
}

void TileSumsBuilder::add_mean(std::uint64_t finite, double mean, double residual, float min, float max) {
  if (finite == 0) return;
  sums.min = sums.finite == 0 ? min : std::min(sums.min, min);
  sums.max = sums.finite == 0 ? max : std::max(sums.max, max);
  sums.finite += finite;
  sum_.add(static_cast<double>(finite) * mean + residual);
}

void TileSumsBuilder::close_mean(float fallback) {
  sums.mean = sums.finite == 0 ? fallback : static_cast<float>(sum_.value() / static_cast<double>(sums.finite));
}

void TileSumsBuilder::add_squares(std::uint64_t finite, double mean, double residual, double sse) {
  const double shift = mean - static_cast<double>(sums.mean);
  const auto n = static_cast<double>(finite);
  sums.residual += n * shift + residual;
  sums.sse += sse + 2.0 * shift * residual + n * shift * shift;
}

}  // namespace weir
