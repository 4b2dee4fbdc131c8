// The time of a VTK XML file: TimeValue of its field data.
#pragma once

#include <optional>

#include "ingest/files/input_file.h"
#include "ingest/source/field_details.h"
#include "ingest/source/source_options.h"
#include "ingest/vtk/vtk_xml_header.h"

namespace weir {

/// Returns the time of `file`, without units because VTK states none; nullopt if the file has no time. A time that
/// cannot be read is reported to options.notice. Throws Error(io) if the device fails.
std::optional<TimePoint> vtk_xml_time(InputFile& file, const VtkXmlHeader& header, const SourceOptions& options);

}  // namespace weir
