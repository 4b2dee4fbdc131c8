// The heads of a packed grid in a file that lies elsewhere: two requests where weir wrote it.
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
  NvdbTree tree;        ///< as read_nvdb_tree_head says
  NvdbBlindData blind;  ///< the macrocells are where they would be; their values were not read
};

/// The file's bytes with the first pages read, its length as its head says it. Throws as `reader`, and Error(input)
/// where the file is no NanoVDB file of one grid; `path` is for messages.
std::unique_ptr<FetchedBytes> fetch_file_head(const std::string& path, RangeReader reader);

/// Reads the heads of the grid and of its packed data, the region table included. Throws the same, and where the grid
/// is not packed.
RemoteHead fetch_heads(FetchedBytes& file, const std::string& path);

}  // namespace weir
