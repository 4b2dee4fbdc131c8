#include "compressor/leaf_errors.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "compressor/certificate.h"

namespace weir {

LeafErrors sum_leaf_errors(const TreeRegions& tree, const RecordStore& records) {
  std::vector<LeafErrors> by_region(tree.regions.size());
  tbb::parallel_for(std::size_t{0}, by_region.size(), [&](std::size_t i) {
    const Region& region = tree.regions[i];
    if (region.leaves == 0) return;
    LeafErrors& errors = by_region[i];
    CompensatedSum squares;
    for (const LeafRecord& record : records.read(region.first_leaf, region.leaves)) {
      squares.add(record.squared_error);
      errors.max_abs = std::max(errors.max_abs, record.max_abs);
      errors.exact = errors.exact && record.exact != 0;
    }
    errors.squared = squares.value();
  });
  LeafErrors total;
  CompensatedSum squares;
  for (const LeafErrors& region : by_region) {
    squares.add(region.squared);
    total.max_abs = std::max(total.max_abs, region.max_abs);
    total.exact = total.exact && region.exact;
  }
  total.squared = squares.value();
  return total;
}

}  // namespace weir
