#include "compressor/encode/leaf_errors.h"

#include <tbb/parallel_for.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "compressor/leaf/certificate.h"

namespace weir {

DecodedErrors sum_region_errors(std::span<const LeafRecord> records, const LeafChoices* seen_by) {
  DecodedErrors errors;
  CompensatedSum squares;
  const auto add = [&](const LeafRecord& record) {
    squares.add(record.squared_error);
    errors.add_but_squares({0, record.max_abs, record.kept, record.zeros_lost});
  };
  if (seen_by == nullptr) {
    for (const LeafRecord& record : records) add(record);
  } else {
    std::size_t next = 0;  // records are in the order of the mask's positions
    for (std::size_t i = 0; i < LeafChoices::kLeaves; ++i) {
      if (!seen_by->kept(i)) continue;
      const LeafRecord& record = records[next++];
      if (seen_by->seen(i)) add(record);
    }
  }
  errors.squared = squares.value();
  return errors;
}

DecodedErrors sum_errors(std::span<const DecodedErrors> by_region) {
  DecodedErrors total;
  CompensatedSum squares;
  for (const DecodedErrors& region : by_region) {
    squares.add(region.squared);
    total.add_but_squares(region);
  }
  total.squared = squares.value();
  return total;
}

DecodedErrors sum_leaf_errors(const TreeRegions& tree, const RecordStore& records, const ChoiceStore* seen_by,
                              Team& team) {
  std::vector<DecodedErrors> by_region(tree.regions.size());
  const auto sum_region = [&](std::size_t i) {
    const Region& region = tree.regions[i];
    if (region.leaves == 0) return;
    std::vector<LeafRecord> room;
    const std::span<const LeafRecord> kept = records.view(region.first_leaf, region.leaves, room);
    std::optional<LeafChoices> seen;
    if (seen_by != nullptr) seen = seen_by->read(static_cast<std::int64_t>(i));
    by_region[i] = sum_region_errors(kept, seen ? &*seen : nullptr);
  };
  const Share own = team.share(static_cast<std::int64_t>(by_region.size()));
  team.run(
      [&] { tbb::parallel_for(static_cast<std::size_t>(own.begin), static_cast<std::size_t>(own.end), sum_region); });
  team.gather(by_region);
  return sum_errors(by_region);
}

}  // namespace weir
