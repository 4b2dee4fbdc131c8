// The error of all kept leaves together, as they decode.
#pragma once

#include "compressor/encode/leaf_record.h"
#include "compressor/leaf/decoded_errors.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/tree_regions.h"
#include "compressor/team/team.h"

namespace weir {

/// Sums the records of all kept leaves, or of those that can be seen by the choices `seen_by`: leaf by leaf in a
/// region, region by region in the tree's order, compensated, so that neither threads nor blocks matter.
DecodedErrors sum_leaf_errors(const TreeRegions& tree, const RecordStore& records, const ChoiceStore* seen_by = nullptr,
                              Team& team = no_team());

}  // namespace weir
