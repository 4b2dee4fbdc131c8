// From a selection to a plan of the file: the mask of every region, the node and
// leaf ordinals in file order, every offset, and the error of the result, which
// for float leaves is known before a single one is written.
#pragma once

#include <cstdint>

#include "compressor/certificate.h"
#include "compressor/leaf_mask.h"
#include "compressor/selection.h"
#include "compressor/tree_regions.h"
#include "format/tree_layout.h"

namespace weir {

struct TreePlan {
  TreeLayout layout;  ///< without padding
  double squared_error = 0;
  double max_abs = 0;
  bool lossless = false;
};

/// One pass over the rows after Selection::choose: writes the masks, fills `leaves`, `node`,
/// `first_leaf` and `squared_error` of the regions and `node` of the upper nodes.
TreePlan plan_tree(const Selection& selection, const RowStore& rows, TreeRegions& tree, MaskStore& masks);

}  // namespace weir
