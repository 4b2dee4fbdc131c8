#include "compressor/encode/leaf_errors.h"

#include <tbb/parallel_for.h>

#include <span>
#include <vector>

#include "compressor/leaf/certificate.h"

namespace weir {

namespace {

// Of each kept leaf of a region, in file order, which is that of the masks: whether it can be seen.
std::vector<bool> seen_leaves(const LeafChoices& choices) {
  std::vector<bool> seen;
  for (std::size_t i = 0; i < LeafChoices::kLeaves; ++i) {
    if (choices.kept(i)) seen.push_back(choices.seen(i));
  }
  return seen;
}

}  // namespace

DecodedErrors sum_leaf_errors(const TreeRegions& tree, const RecordStore& records, const ChoiceStore* seen_by,
                              Team& team) {
  std::vector<DecodedErrors> by_region(tree.regions.size());
  const auto sum_region = [&](std::size_t i) {
    const Region& region = tree.regions[i];
    if (region.leaves == 0) return;
    DecodedErrors& errors = by_region[i];
    CompensatedSum squares;
    std::vector<LeafRecord> room;
    const std::span<const LeafRecord> kept = records.view(region.first_leaf, region.leaves, room);
    const std::vector<bool> seen = seen_by == nullptr ? std::vector<bool>(kept.size(), true)
                                                      : seen_leaves(seen_by->read(static_cast<std::int64_t>(i)));
    for (std::size_t leaf = 0; leaf < kept.size(); ++leaf) {
      if (!seen[leaf]) continue;
      const LeafRecord& record = kept[leaf];
      squares.add(record.squared_error);
      errors.add_but_squares({0, record.max_abs, record.kept, record.zeros_lost});
    }
    errors.squared = squares.value();
  };
  const Share own = team.share(static_cast<std::int64_t>(by_region.size()));
  team.run(
      [&] { tbb::parallel_for(static_cast<std::size_t>(own.begin), static_cast<std::size_t>(own.end), sum_region); });
  team.gather(by_region);
  DecodedErrors total;
  CompensatedSum squares;
  for (const DecodedErrors& region : by_region) {
    squares.add(region.squared);
    total.add_but_squares(region);
  }
  total.squared = squares.value();
  return total;
}

}  // namespace weir
