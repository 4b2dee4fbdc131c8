// The tree of a packed grid's blocks, see export_tree.h.
#pragma once

#include <memory>

#include "tools/export/export_tree.h"

namespace weir {

/// `grid`, which is packed, must outlive the tree. There is a leaf for each block that has a stream or overhangs the
/// domain, and tiles of 8^3 and 128^3 voxels for the others; voxels outside the domain are inactive and background.
std::unique_ptr<ExportTree> make_packed_export_tree(const NvdbGrid& grid);

}  // namespace weir
