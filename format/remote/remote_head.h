// Reads the heads of a packed grid in a remote file; two requests are enough for a file written by weir.
#pragma once

#include <memory>
#include <string>

#include "format/nanovdb/nvdb_blind.h"
#include "format/nanovdb/nvdb_header.h"
#include "format/nanovdb/nvdb_tree.h"
#include "format/remote/fetched_bytes.h"

namespace weir {

struct RemoteHead {
  NvdbHeader header;
  NvdbTree tree;        ///< as from read_nvdb_tree_head()
  NvdbBlindData blind;  ///< the macrocells have their place, but their values were not read
};

/// Returns the file's bytes with the first pages read; the head tells the file's length. Throws as `reader`, and
/// Error(input) if the file is not a NanoVDB file of one grid; `path` is for messages.
std::unique_ptr<FetchedBytes> fetch_file_head(const std::string& path, RangeReader reader);

/// Reads the heads of the grid and of its packed data, including the region table. Throws as fetch_file_head(), and
/// Error(input) if the grid is not packed.
RemoteHead fetch_heads(FetchedBytes& file, const std::string& path);

}  // namespace weir
