// The error of all kept leaves together, as they decode.
#pragma once

#include "compressor/encode/leaf_record.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/tree_regions.h"
#include "compressor/team/team.h"

namespace weir {

struct LeafErrors {
  double squared = 0;  ///< sum over the finite in-domain values
  double max_abs = 0;
  bool exact = true;             ///< every voxel reads the bits it should
  std::uint64_t zeros_lost = 0;  ///< zeros that read another value
};

/// Sums the records of all kept leaves, or of those that can be seen by the choices `seen_by`: leaf by leaf in a
/// region, region by region in the tree's order, compensated, so that neither threads nor blocks matter.
LeafErrors sum_leaf_errors(const TreeRegions& tree, const RecordStore& records, const ChoiceStore* seen_by = nullptr,
                           Team& team = no_team());

}  // namespace weir
