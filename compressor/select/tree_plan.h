// From a selection to a plan of the file: the choices of every region, the node and
// leaf ordinals in file order, every offset, and the error of the result, which
// for float leaves is known before a single one is written.
#pragma once

#include <array>
#include <cstdint>

#include "compressor/leaf/decoded_errors.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/selection.h"
#include "compressor/select/tree_regions.h"
#include "format/layout/tree_layout.h"

namespace weir {

struct TreePlan {
  TreeLayout layout;  ///< without padding
  // Exact. Leaves add theirs when they are encoded (leaf_record.h); float ones add none.
  DecodedErrors tiles;         ///< of what reads a tile
  DecodedErrors seen_tiles;    ///< of what of that can be seen: all, unless a scene says otherwise
  double expected_error = 0;   ///< squared, of tiles and kept leaves, estimated; weighted where the rule weighs
  bool loses_nothing = false;  ///< every bit that can be seen is read
  /// Kept leaves by log2(bits a voxel), 5 for float32.
  std::array<std::uint64_t, 6> leaves_by_width{};
  std::array<std::uint64_t, kPackedKinds> blocks{};  ///< with a stream, by PackedKind
  std::uint64_t kept = 0;   ///< kept leaves, or blocks with a stream: the encode pass writes a record of each
  std::uint64_t zeros = 0;  ///< in the source
  DecodedErrors preview;    ///< of a packed file: of what other readers see in the tree
};

/// One pass over the rows after Selection::choose: writes the choices, fills `leaves`, `leaf_bytes`, `node`,
/// `first_leaf`, `first_byte` and `squared_error` of the regions and `node` of the upper nodes.
/// Of a packed file the streams go to `streams`.
TreePlan plan_tree(const Selection& selection, const RowStore& rows, TreeRegions& tree, ChoiceStore& choices,
                   PlannedStreamsStore* streams = nullptr);

}  // namespace weir
