// The error of all kept leaves together, as they decode.
#pragma once

#include <span>

#include "compressor/encode/leaf_record.h"
#include "compressor/leaf/decoded_errors.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/tree_regions.h"
#include "compressor/team/team.h"

namespace weir {

/// Sums the records of a region's kept leaves, or of those that can be seen by its choices `seen_by`: in their order,
/// compensated.
DecodedErrors sum_region_errors(std::span<const LeafRecord> records, const LeafChoices* seen_by = nullptr);

/// Sums those of all regions, in the tree's order, compensated.
DecodedErrors sum_errors(std::span<const DecodedErrors> by_region);

/// Both, of the records of all kept leaves, or of those that can be seen by the choices `seen_by`: neither threads nor
/// blocks matter.
DecodedErrors sum_leaf_errors(const TreeRegions& tree, const RecordStore& records, const ChoiceStore* seen_by = nullptr,
                              Team& team = no_team());

}  // namespace weir
