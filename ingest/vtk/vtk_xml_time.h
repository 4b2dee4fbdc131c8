// The time of a VTK XML file: TimeValue of its field data.
#pragma once

#include <optional>

#include "ingest/files/input_file.h"
#include "ingest/source/field_details.h"
#include "ingest/source/source_options.h"
#include "ingest/vtk/vtk_xml_header.h"

namespace weir {

/// The time of `file`, whose units VTK does not say; nullopt where it has none. One that cannot be read is said to
/// options.notice. Throws Error(io) where the device fails.
std::optional<TimePoint> vtk_xml_time(InputFile& file, const VtkXmlHeader& header, const SourceOptions& options);

}  // namespace weir
