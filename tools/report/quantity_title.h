// Names the values of a volume in a few words for a chart.
#pragma once

#include <string>

#include "format/nanovdb/nvdb_file.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Returns "cloud water mixing ratio (kg kg-1)": the long name, otherwise the last part of the name, and the units if
/// they are known. For a file these come from its sidecar; without a sidecar, the last part of the grid's name is
/// returned.
std::string quantity_title(const NvdbFile& file);
std::string quantity_title(const SourceInfo& source);

}  // namespace weir
