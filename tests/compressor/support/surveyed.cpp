#include "tests/compressor/support/surveyed.h"

#include <algorithm>
#include <cmath>

#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/crash_file_system.h"

namespace weir::test {

Surveyed::Surveyed(MemoryVolume& of, std::uint64_t block_bytes, const SelectionRoom& room)
    : volume(of),
      plan(plan_blocks(of.info().domain(), of.access(), block_bytes)),
      rows(CrashFileSystem().create_unnamed("rows"), plan.lattice, room),
      survey(survey_volume(of, plan, rows, {})) {}

std::vector<LeafRow> Surveyed::all_rows() const {
  std::vector<LeafRow> all(static_cast<std::size_t>(rows.leaves().size()));
  rows.read(0, all);
  return all;
}

Chooser::Chooser(const Box& domain, const RowStore& rows, const GainRule& rule)
    : rows_(rows), tree_(domain), selection_(rule, rows, tree_) {}

Chooser::Chooser(const Surveyed& surveyed, const GainRule& rule)
    : Chooser(surveyed.volume.info().domain(), surveyed.rows, rule) {}

Choice Chooser::choose(std::uint64_t file_bytes) {
  selection_.choose(file_bytes);
  ChoiceStore masks(CrashFileSystem().create_unnamed("masks"), tree_.region_lattice.size());
  Choice choice;
  choice.plan = plan_tree(selection_, rows_, tree_, masks);
  choice.kept.resize(static_cast<std::size_t>(tree_.leaves.size()));
  for (std::int64_t i = 0; i < tree_.leaves.size(); ++i) {
    const Index3 node = tree_.leaves.first + tree_.leaves.position(i);
    const std::int64_t region = tree_.region_lattice.linear(floor_div(node, kLowerLeaves) - tree_.region_lattice.first);
    choice.kept[static_cast<std::size_t>(i)] = masks.read(region).kept(tree_.mask_position(tree_.leaves.position(i)));
  }
  for (const Region& region : tree_.regions) choice.region.push_back(region.open);
  for (const Upper& upper : tree_.uppers) choice.upper.push_back(upper.open);
  return choice;
}

RegionGains Chooser::gains(std::int64_t region) const {
  std::vector<LeafRow> rows;
  const Box box = tree_.leaf_box(region);
  rows_.read_box(box, rows);
  RegionGains gains;
  selection_.rule().gains(tree_, RegionRows(rows.data(), box.extent(), box), gains);
  return gains;
}

MeasuredError measured_error(const MemoryVolume& volume, const Fill& fill, const TreeRegions& tree,
                             const Choice& choice) {
  MeasuredError error;
  long double squared = 0;
  const auto add = [&](const Box& box, bool kept, float tile) {
    for (const float v : volume.in(box)) {
      const bool replaced = !std::isfinite(v) && fill.non_finite != NonFinitePolicy::keep;
      const float source = replaced ? fill.background : v;
      const float read = kept ? source : tile;
      error.lossless = error.lossless && bits_of(read) == bits_of(source);
      if (!std::isfinite(v)) continue;
      const long double d = std::abs(static_cast<long double>(v) - static_cast<long double>(read));
      squared += d * d;
      error.max_abs = std::max(error.max_abs, static_cast<double>(d));
    }
  };
  for (std::int64_t u = 0; u < tree.upper_lattice.size(); ++u) {
    const Box upper = tree.upper_lattice.voxels(tree.upper_lattice.position(u));
    if (!choice.upper[static_cast<std::size_t>(u)]) {
      add(upper, false, expected_tile(volume, upper, fill.mode, fill.background));
      continue;
    }
    tree.for_each_region_of(u, [&](std::int64_t r) {
      const Box region = tree.region_lattice.voxels(tree.region_lattice.position(r));
      if (!choice.region[static_cast<std::size_t>(r)]) {
        add(region, false, expected_tile(volume, region, fill.mode, fill.background));
        return;
      }
      const Box leaves = tree.leaf_box(r);
      for (std::int64_t n = 0; n < leaves.voxels(); ++n) {
        const Index3 leaf = leaves.lo + index_at(n, leaves.extent());
        const Box box = tree.leaves.voxels(leaf);
        add(box, choice.kept[static_cast<std::size_t>(tree.leaves.linear(leaf))],
            expected_tile(volume, box, fill.mode, fill.background));
      }
    });
  }
  error.squared = static_cast<double>(squared);
  return error;
}

}  // namespace weir::test
