#include "compressor/select/tree_plan.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "format/nanovdb/macrocells.h"

namespace weir {
namespace {

Kept kept_of_tiles(const TileSums& sums) { return kept_of(sums.keeps_values, sums.exact); }

// The figures of a plan that can be merged in any order.
struct PlanTally {
  double max_abs = 0;
  double seen_max_abs = 0;
  Kept kept = Kept::all;         // by tiles
  Kept seen_kept = Kept::all;    // by visible tiles
  std::uint64_t zeros_lost = 0;  // to tiles
  bool leaves_exact = true;      // visible leaves are exact at their widths
  std::array<std::uint64_t, 6> leaves_by_width{};
  std::array<std::uint64_t, kPackedKinds> blocks{};

  void add(const PlanTally& other) {
    max_abs = std::max(max_abs, other.max_abs);
    seen_max_abs = std::max(seen_max_abs, other.seen_max_abs);
    kept = std::min(kept, other.kept);
    seen_kept = std::min(seen_kept, other.seen_kept);
    zeros_lost += other.zeros_lost;
    leaves_exact = leaves_exact && other.leaves_exact;
    for (std::size_t i = 0; i < leaves_by_width.size(); ++i) leaves_by_width[i] += other.leaves_by_width[i];
    for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i] += other.blocks[i];
  }
};

// Squared errors of a region.
struct RegionErrors {
  double seen = 0;      // of visible voxels that read a tile
  double expected = 0;  // of kept leaves and, if a scene weighs, of tiles; weighted
  // Errors of the preview of a packed region, which other readers see.
  double preview = 0;
  double preview_max_abs = 0;
};

// Plans one region after the other; different regions on different threads.
class RegionPlanner {
 public:
  RegionPlanner(const GainRule& rule, const TreeRegions& tree) : rule_(rule), tree_(tree) {}

  // Marks the leaves that can be seen.
  void mark(const RegionRows& rows, LeafChoices& choices) const {
    rows.for_each([&](const Index3& leaf, const LeafRow&) {
      if (seen(rows, leaf)) choices.set_seen(tree_.mask_position(leaf));
    });
  }

  // Adds the leaves of an open region. Sets `region.squared_error` to the error of the leaves that became tiles.
  RegionErrors add_leaves(const LeafChoices& choices, const RegionRows& rows, Region& region, PlanTally& tally) const {
    CompensatedSum squares;
    CompensatedSum seen_squares;
    CompensatedSum expected;
    const bool whole = are_whole(tree_.leaves, rows.leaf_box());
    std::optional<RegionStreams> streams;
    if (rule_.packed) streams.emplace(region.packed_means, *rule_.packed);
    rows.for_each([&](const Index3& leaf, const LeafRow& row) {
      const std::size_t position = tree_.mask_position(leaf);
      const LeafWidth width = choices.width(position);
      const std::int64_t voxels = whole ? kLeafVoxels : tree_.leaves.voxels(leaf).voxels();
      if (width != LeafWidth::tile) {
        const double weight = rule_.visibility == nullptr ? 1 : rule_.visibility->weight(rows.reach(leaf));
        if (rule_.packed) {
          const KeptLevel level = choices.level(position);
          expected.add(weight * streams->error(rows.ladder(leaf), level, row, voxels));
          const bool exact = level == kExactLevel && rows.ladder(leaf).exact != ExactKind::bounded;
          ++tally.blocks[static_cast<std::size_t>(packed_kind(rows.ladder(leaf), level))];
          tally.leaves_exact = tally.leaves_exact && (!choices.seen(position) || exact);
          return;
        }
        ++tally.leaves_by_width[bits_log2_of(width)];
        expected.add(weight * quantised_error(row, voxels, rule_.fill.background, width));
        tally.leaves_exact = tally.leaves_exact &&
                             (!choices.seen(position) || keeps_every_bit(row, voxels, rule_.fill.background, width));
        return;
      }
      const float value = rule_.packed ? region.packed_value : rule_.fill.leaf_value(row);
      const Kept kept = kept_of(Fill::keeps_values(row, value), rule_.fill.exact(row, voxels, value));
      squares.add(row.sse_about(value));
      tally.max_abs = std::max(tally.max_abs, row.max_abs_about(value));
      tally.kept = std::min(tally.kept, kept);
      tally.zeros_lost += row.zeros_lost_to(value);
      if (rule_.visibility == nullptr) return;
      add_seen_tile(rows, leaf, value, kept, seen_squares, expected, tally);
    });
    region.squared_error = squares.value();
    return {seen_squares.value(), expected.value()};
  }

  // Adds a region in which every voxel reads `value`.
  RegionErrors add_tile(const RegionRows& rows, float value, Kept kept, Region& region, PlanTally& tally) const {
    region.squared_error = region.sums.sse_about(value);
    tally.max_abs = std::max(tally.max_abs, region.sums.max_abs_about(value));
    tally.kept = std::min(tally.kept, kept);
    tally.zeros_lost += region.sums.zeros_lost_to(value);
    if (rule_.visibility == nullptr) return {};
    CompensatedSum seen_squares;
    CompensatedSum expected;
    rows.for_each([&](const Index3& leaf, const LeafRow&) {
      add_seen_tile(rows, leaf, value, kept, seen_squares, expected, tally);
    });
    return {seen_squares.value(), expected.value()};
  }

  // Adds the errors of a reader of the tree alone. It reads each block's mean if `means` is set, otherwise `value`.
  void add_preview(const RegionRows& rows, bool means, float value, RegionErrors& errors) const {
    CompensatedSum squares;
    rows.for_each([&](const Index3&, const LeafRow& row) {
      const float seen_value = means ? rule_.fill.leaf_value(row) : value;
      squares.add(row.sse_about(seen_value));
      errors.preview_max_abs = std::max(errors.preview_max_abs, row.max_abs_about(seen_value));
    });
    errors.preview = squares.value();
  }

 private:
  bool seen(const RegionRows& rows, const Index3& leaf) const {
    return rule_.visibility == nullptr || rule_.visibility->shows(rows.reach(leaf));
  }

  void add_seen_tile(const RegionRows& rows, const Index3& leaf, float value, Kept kept, CompensatedSum& squares,
                     CompensatedSum& expected, PlanTally& tally) const {
    const LeafRow& row = rows.at(leaf);
    expected.add(rule_.tile_weight(rows.reach(leaf), value) * row.sse_about(value));
    if (!seen(rows, leaf)) return;
    squares.add(row.sse_about(value));
    tally.seen_max_abs = std::max(tally.seen_max_abs, row.max_abs_about(value));
    tally.seen_kept = std::min(tally.seen_kept, kept);
  }

  const GainRule& rule_;
  const TreeRegions& tree_;
};

// Numbers the chunks of a packed file in the order that their nodes would have. Returns the number of streams.
std::uint64_t number_chunks(const PackedRule& rule, TreeRegions& tree, NodeCounts& counts) {
  std::uint64_t streams = 0;
  std::uint64_t bytes = 0;
  std::uint64_t uppers = 0;
  std::uint64_t regions = 0;
  std::uint64_t tiles = 0;
  tree.for_each_upper([&](std::int64_t u) {
    tree.uppers[static_cast<std::size_t>(u)].node = uppers++;
    tree.for_each_region_of(u, [&](std::int64_t r) {
      Region& region = tree.regions[static_cast<std::size_t>(r)];
      if (!region.open) return;
      region.node = regions++;
      region.first_leaf = streams;
      region.first_byte = bytes;
      streams += region.leaves;
      bytes += region.leaf_bytes;
      tiles += static_cast<std::uint64_t>(tree.leaf_box(r).voxels());
    });
  });
  set_packed_counts(rule, tree, regions, counts);
  counts.packed_bytes += bytes;
  counts.leaf_tiles = rule.preview ? tiles - counts.leaves : 0;
  return streams;
}

void number_in_file_order(TreeRegions& tree, NodeCounts& counts) {
  tree.for_each_upper([&](std::int64_t u) {
    Upper& upper = tree.uppers[static_cast<std::size_t>(u)];
    if (!upper.open) return;
    upper.node = counts.uppers++;
    tree.for_each_region_of(u, [&](std::int64_t r) {
      Region& region = tree.regions[static_cast<std::size_t>(r)];
      if (!region.open) return;
      region.node = counts.lowers++;
      region.first_leaf = counts.leaves;
      region.first_byte = counts.leaf_bytes;
      counts.leaves += region.leaves;
      counts.leaf_tiles += static_cast<std::uint64_t>(tree.leaf_box(r).voxels()) - region.leaves;
      counts.leaf_bytes += region.leaf_bytes;
    });
  });
}

// Plans the streams of a region. Its `leaves` and `leaf_bytes` become the streams and bytes of its chunk.
void plan_region_streams(const GainRule& rule, TreeRegions& tree, const RegionRows& rows, const LeafChoices& choices,
                         std::int64_t index, PlannedStreamsStore& streams) {
  Region& region = tree.regions[static_cast<std::size_t>(index)];
  if (!region.open) return;
  const SharedValues shared{region.packed_value, region.packed_means};
  auto planned = std::make_unique<PlannedStreams>(plan_streams(rows, tree, shared, *rule.packed, choices));
  streams.write(index, *planned);
  const StreamPlaces places(std::move(planned));
  region.leaves = places.streams();
  region.leaf_bytes = places.chunk_bytes();
}

// The inputs of a plan, and the stores for its parts.
struct PlanParts {
  const Selection& selection;
  TreeRegions& tree;
  ChoiceStore& choices;
  PlannedStreamsStore* streams;
};

// Plans a region: its choices, the number of leaves kept, and its errors.
RegionErrors plan_region(const PlanParts& parts, const RegionPlanner& planner, std::int64_t index,
                         const RegionRows& rows, RegionGains& gains, PlanTally& tally) {
  const GainRule& rule = parts.selection.rule();
  TreeRegions& tree = parts.tree;
  Region& region = tree.regions[static_cast<std::size_t>(index)];
  LeafChoices choices = parts.selection.choices(index, rows, gains);
  planner.mark(rows, choices);
  parts.choices.write(index, choices);
  if (rule.packed) {
    plan_region_streams(rule, tree, rows, choices, index, *parts.streams);
  } else {
    const LeafPlaces::Place total = LeafPlaces(choices).total();
    region.leaves = total.leaves;
    region.leaf_bytes = total.bytes;
  }
  const Upper& upper = tree.uppers[static_cast<std::size_t>(tree.upper_of(index))];
  RegionErrors errors;
  if (region.open) {
    errors = planner.add_leaves(choices, rows, region, tally);
  } else if (rule.packed) {
    errors = planner.add_tile(rows, region.packed_value, kept_of_tiles(region.sums), region, tally);
  } else {
    // One tile, of this region or of the whole upper node.
    const TileSums& sums = upper.open ? region.sums : upper.sums;
    errors = planner.add_tile(rows, tile_value(rule.fill, sums), kept_of_tiles(sums), region, tally);
  }
  if (rule.packed) {
    const bool nodes = rule.packed->preview;
    planner.add_preview(rows, nodes && region.open, tile_value(rule.fill, nodes ? region.sums : upper.sums), errors);
  }
  return errors;
}

// Returns a plan with the errors of all regions, summed in the regions' order.
TreePlan summed(const GainRule& rule, const TreeRegions& tree, const std::vector<RegionErrors>& errors,
                const PlanTally& total) {
  TreePlan plan;
  CompensatedSum squares;
  for (const Region& region : tree.regions) squares.add(region.squared_error);
  CompensatedSum seen;
  CompensatedSum expected;
  CompensatedSum preview;
  for (const RegionErrors& of_region : errors) {
    seen.add(of_region.seen);
    expected.add(of_region.expected);
    preview.add(of_region.preview);
    plan.preview.max_abs = std::max(plan.preview.max_abs, of_region.preview_max_abs);
  }
  plan.preview.squared = preview.value();
  const bool same_values = plan.preview.squared == 0 && plan.preview.max_abs == 0 && rule.packed.has_value();
  plan.preview.kept = same_values ? Kept::all : Kept::lossy;
  plan.tiles = {squares.value(), total.max_abs, total.kept, total.zeros_lost};
  for (const Region& region : tree.regions) plan.zeros += region.sums.zeros;
  const bool weighed = rule.visibility != nullptr;
  plan.seen_tiles = weighed ? DecodedErrors{seen.value(), total.seen_max_abs, total.seen_kept, 0} : plan.tiles;
  plan.expected_error = weighed ? expected.value() : plan.tiles.squared + expected.value();
  plan.loses_nothing = plan.seen_tiles.kept == Kept::all && total.leaves_exact;
  plan.leaves_by_width = total.leaves_by_width;
  plan.blocks = total.blocks;
  return plan;
}

// Gives the nodes and leaves of the tree their places.
void lay_out(const GainRule& rule, TreeRegions& tree, TreePlan& plan) {
  NodeCounts counts;
  counts.root_tiles = tree.uppers.size();
  counts.macrocells = static_cast<std::uint64_t>(make_lattice(tree.leaves.domain, kMacrocell).size());
  if (rule.packed) {
    plan.kept = number_chunks(*rule.packed, tree, counts);
  } else {
    number_in_file_order(tree, counts);
    plan.kept = counts.leaves;
    if (!rule.fill.active()) counts.leaf_tiles = 0;
  }
  plan.layout = make_layout(counts);
}

}  // namespace

TreePlan plan_tree(const Selection& selection, const RowStore& rows, TreeRegions& tree, ChoiceStore& store,
                   PlannedStreamsStore* streams) {
  const GainRule& rule = selection.rule();
  const RegionPlanner planner(rule, tree);
  tbb::enumerable_thread_specific<PlanTally> tallies;
  tbb::enumerable_thread_specific<RegionGains> gains;
  std::vector<RegionErrors> errors(tree.regions.size());
  for_each_own_region(tree, rows, [&](std::int64_t index, const RegionRows& region_rows) {
    errors[static_cast<std::size_t>(index)] =
        plan_region({selection, tree, store, streams}, planner, index, region_rows, gains.local(), tallies.local());
  });

  Team& team = rows.team();
  team.gather(tree.regions);
  team.gather(errors);
  store.publish(team);
  if (streams != nullptr) streams->publish(team);
  std::vector<PlanTally> parts(tallies.begin(), tallies.end());
  team.concatenate(parts);
  PlanTally total;
  for (const PlanTally& other : parts) total.add(other);
  TreePlan plan = summed(rule, tree, errors, total);
  lay_out(rule, tree, plan);
  return plan;
}

}  // namespace weir
