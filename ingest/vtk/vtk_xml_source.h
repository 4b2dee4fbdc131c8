// VTK XML image data, .vti.
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

/// Of the names of its files, in lower case.
inline constexpr std::array<std::string_view, 1> kVtkXmlEndings{".vti"};

/// By the name, or where the file begins with VTK's own element.
bool recognises_vtk_xml(std::string_view path, std::span<const std::byte> head);

/// The array options.dataset of the points or the cells; else, ghost types and the like aside, the only one that can be
/// converted, else the one that the file marks as its scalars. Raw appended values without compression are read where
/// they lie; all others are decoded here, once, into a spool file. Throws Error(usage) where several can be converted
/// and none is named or marked; Error(input) for what parse_vtk_xml_header refuses and where data and header do not
/// agree, and what SpoolFile throws.
std::unique_ptr<VolumeSource> open_vtk_xml(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_vtk_xml(const std::string& path, const SourceOptions& options);

}  // namespace weir
