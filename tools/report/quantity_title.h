// What the values of a volume are, in a few words for a chart.
#pragma once

#include <string>

#include "format/nanovdb/nvdb_file.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// "cloud water mixing ratio (kg kg-1)": the long name, or else the last part of the name, and the units where they are
/// known. Of a file as its sidecar says it; without a sidecar that is the file's, the last part of its grid's name.
std::string quantity_title(const NvdbFile& file);
std::string quantity_title(const SourceInfo& source);

}  // namespace weir
