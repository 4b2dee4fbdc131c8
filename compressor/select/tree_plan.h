// Turns a selection into a plan of the file: the choices of every region, the node and leaf ordinals in file order,
// every offset, and the error of the result. For float leaves the error is known before any leaf is written.
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
  // Exact errors. Leaves add their errors when they are encoded (leaf_record.h); float leaves add none.
  DecodedErrors tiles;         ///< of voxels that read a tile
  DecodedErrors seen_tiles;    ///< of visible voxels that read a tile: all, unless there is a scene
  double expected_error = 0;   ///< squared, of tiles and kept leaves, estimated; weighted if the rule weighs
  bool loses_nothing = false;  ///< every visible voxel reads its own bits
  /// Kept leaves by log2(bits a voxel), 5 for float32.
  std::array<std::uint64_t, 6> leaves_by_width{};
  std::array<std::uint64_t, kPackedKinds> blocks{};  ///< with a stream, by PackedKind
  std::uint64_t kept = 0;   ///< kept leaves, or blocks with a stream: the encode pass writes a record of each
  std::uint64_t zeros = 0;  ///< in the source
  DecodedErrors preview;    ///< for a packed file: errors of the tree that other readers see
};

/// Plans the file in one pass over the rows, after Selection::choose(). Writes the choices. Fills `leaves`,
/// `leaf_bytes`, `node`, `first_leaf`, `first_byte` and `squared_error` of the regions, and `node` of the upper nodes.
/// For a packed file, writes the planned streams to `streams`.
TreePlan plan_tree(const Selection& selection, const RowStore& rows, TreeRegions& tree, ChoiceStore& choices,
                   PlannedStreamsStore* streams = nullptr);

}  // namespace weir
