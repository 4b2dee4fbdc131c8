// Which files a volume lies in, for what must not be written over them.
#pragma once

#include <vector>

#include "format/io/file_id.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Those that `info` names, as they were opened, and the one that its path leads to now.
std::vector<FileId> source_file_ids(const SourceInfo& info);

}  // namespace weir
