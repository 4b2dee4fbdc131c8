// After the leaves: writes the inner nodes, the macrocells and the head, so that
// the file is a NanoVDB grid.
#pragma once

#include <cstdint>

#include "compressor/encode/layer_encoder.h"
#include "compressor/encode/leaf_record.h"
#include "compressor/leaf/fill.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/tree_regions.h"
#include "compressor/survey/row_store.h"
#include "format/io/file_system.h"
#include "format/layout/tree_layout.h"
#include "format/nanovdb/grid_head.h"

namespace weir {

struct TreeParts {
  const TreeRegions& tree;
  const RowStore& rows;
  const ChoiceStore& choices;
  const RecordStore& records;
  Fill fill;
  TreeLayout layout;                     ///< padded to the file's size
  const PackedTarget* packed = nullptr;  ///< of a packed file
};

/// Writes everything but the leaves, and of a packed file the streams with their ends, to `out`, which has the file's
/// size and reads zero where nothing was written. `head` carries name, type, voxel size and origin; the rest of it is
/// filled in. Returns the head's checksum.
std::uint32_t write_tree(const TreeParts& parts, GridHead head, File& out);

}  // namespace weir
