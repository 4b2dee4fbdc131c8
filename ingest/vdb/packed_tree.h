// Reads the packed grid of a NanoVDB file as a tree of blocks. Uses pread and not a mapping, as nvdb_leaf_tree.h
// does, so that a file that is cut or rewritten during the reading gives an error and not a signal.
#pragma once

#include <memory>

#include "format/nanovdb/nvdb_grid.h"
#include "ingest/files/input_file.h"
#include "ingest/vdb/leaf_source.h"

namespace weir {

/// Returns the tree of `grid`, which is packed. `grid` is a view of the content of `file` when it was opened, and is
/// used during this call only. `cached` says that its pages are in memory already.
std::unique_ptr<LeafTree> make_packed_tree(std::unique_ptr<InputFile> file, const NvdbGrid& grid, bool cached);

}  // namespace weir
