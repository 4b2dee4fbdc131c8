// The decoded error of all kept leaves together.
#pragma once

#include <span>

#include "compressor/encode/leaf_record.h"
#include "compressor/leaf/decoded_errors.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/tree_regions.h"
#include "compressor/team/team.h"

namespace weir {

/// Sums the errors of a region's kept leaves in their order, with compensation. If `seen_by` (the region's choices) is
/// given, sums only the leaves that can be seen.
DecodedErrors sum_region_errors(std::span<const LeafRecord> records, const LeafChoices* seen_by = nullptr);

/// Sums the errors of all regions in the tree's order, with compensation.
DecodedErrors sum_errors(std::span<const DecodedErrors> by_region);

/// Returns the errors of all kept leaves by their records, or only of the leaves that can be seen by the choices
/// `seen_by`. The result does not depend on threads or blocks.
DecodedErrors sum_leaf_errors(const TreeRegions& tree, const RecordStore& records, const ChoiceStore* seen_by = nullptr,
                              Team& team = no_team());

}  // namespace weir
