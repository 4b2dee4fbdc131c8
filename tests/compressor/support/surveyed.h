// A volume in memory with its survey, and selections over it.
#pragma once

#include <cstdint>
#include <vector>

#include "compressor/select/leaf_choice.h"
#include "compressor/select/selection.h"
#include "compressor/select/tree_plan.h"
#include "compressor/survey/survey.h"
#include "ingest/plan/block_plan.h"
#include "tests/compressor/support/memory_volume.h"

namespace weir::test {

struct Surveyed {
  /// Surveys `of` in blocks of up to `block_bytes`. `room` is the memory that selection may use.
  explicit Surveyed(MemoryVolume& of, std::uint64_t block_bytes = std::uint64_t{1} << 30U,
                    const SelectionRoom& room = {64, std::uint64_t{1} << 24U});

  MemoryVolume& volume;
  BlockPlan plan;
  RowStore rows;
  Survey survey;

  std::vector<LeafRow> all_rows() const;  ///< in leaf order
};

/// What selection chose for one size.
struct Choice {
  std::vector<bool> kept;    ///< kept leaves, by leaf index
  std::vector<bool> region;  ///< open regions, by region index
  std::vector<bool> upper;   ///< open upper nodes
  TreePlan plan;
};

/// Uses one Selection for several choices.
class Chooser {
 public:
  Chooser(const Box& domain, const RowStore& rows, const GainRule& rule);
  Chooser(const Surveyed& surveyed, const GainRule& rule);

  const Selection& selection() const { return selection_; }
  const TreeRegions& tree() const { return tree_; }
  std::uint64_t minimum() const { return selection_.bytes().minimum.file_bytes; }
  std::uint64_t lossless() const { return selection_.bytes().full.file_bytes; }
  Choice choose(std::uint64_t file_bytes);
  /// Returns the gains of one region in leaf order.
  RegionGains gains(std::int64_t region) const;

 private:
  const RowStore& rows_;
  TreeRegions tree_;
  Selection selection_;
};

/// The error of a choice, measured voxel by voxel.
struct MeasuredError {
  double squared = 0;  ///< sum in long double over the finite voxels
  double max_abs = 0;
  bool lossless = true;  ///< all bits are the same
};

MeasuredError measured_error(const MemoryVolume& volume, const Fill& fill, const TreeRegions& tree,
                             const Choice& choice);

}  // namespace weir::test
