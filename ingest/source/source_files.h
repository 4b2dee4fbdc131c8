// Finds the files of a volume, so that an output does not overwrite them.
#pragma once

#include <vector>

#include "format/io/file_id.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Returns the ids of the files that `info` names, as they were opened, and of the file that its path leads to now.
std::vector<FileId> source_file_ids(const SourceInfo& info);

}  // namespace weir
