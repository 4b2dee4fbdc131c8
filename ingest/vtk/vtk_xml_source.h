// Opens VTK XML image data (.vti).
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/source/dataset_info.h"
#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Endings of the file names, in lower case.
inline constexpr std::array<std::string_view, 1> kVtkXmlEndings{".vti"};

/// Recognises a file by its name, or if it begins with VTK's own element.
bool recognises_vtk_xml(std::string_view path, std::span<const std::byte> head);

/// Opens the array `options.dataset` of the points or the cells. Without a name, and leaving ghost types and similar
/// marks aside, opens the only array that can be converted, otherwise the array that the file marks as its scalars.
/// Raw appended values without compression are read in place. This call decodes all others once into a spool file.
/// Throws Error(usage) if several arrays can be converted and none is named or marked, Error(input) for files that
/// parse_vtk_xml_header() refuses and if data and header disagree, and the errors of SpoolFile.
std::unique_ptr<VolumeSource> open_vtk_xml(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_vtk_xml(const std::string& path, const SourceOptions& options);

}  // namespace weir
