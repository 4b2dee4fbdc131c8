// The export tree (export_tree.h) of a packed grid's blocks.
#pragma once

#include <memory>

#include "tools/export/export_tree.h"

namespace weir {

/// Makes the tree of `grid`, which must be packed and outlive the tree. Each block that has a stream or overhangs the
/// domain becomes a leaf; the others become tiles of 8^3 and 128^3 voxels. Voxels outside the domain are inactive and
/// have the background value.
std::unique_ptr<ExportTree> make_packed_export_tree(const NvdbGrid& grid);

}  // namespace weir
