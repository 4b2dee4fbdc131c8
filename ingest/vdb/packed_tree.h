// The packed grid of a NanoVDB file as a tree of blocks. Read by pread and not by a mapping, as nvdb_leaf_tree.h: a
// file that is cut or rewritten meanwhile is an error, not a signal.
#pragma once

#include <memory>

#include "format/nanovdb/nvdb_grid.h"
#include "ingest/files/input_file.h"
#include "ingest/vdb/leaf_source.h"

namespace weir {

/// `grid`, which is packed, is a view of what `file` held when it was opened, and is looked at during this call only;
/// `cached` tells that its pages are in memory already.
std::unique_ptr<LeafTree> make_packed_tree(std::unique_ptr<InputFile> file, const NvdbGrid& grid, bool cached);

}  // namespace weir
