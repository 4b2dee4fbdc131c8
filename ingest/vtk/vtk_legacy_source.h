// Opens legacy VTK structured points (.vtk).
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
inline constexpr std::array<std::string_view, 1> kVtkLegacyEndings{".vtk"};

/// Recognises a file by its first line or its name.
bool recognises_vtk_legacy(std::string_view path, std::span<const std::byte> head);

/// Opens the array `options.dataset` of the points or the cells, or the only array that can be converted, ghost types
/// and similar marks aside. Binary values are read in place. This call decodes text values once into a spool file.
/// Throws Error(usage) if several arrays can be converted and none is named, Error(input) for files that
/// parse_vtk_legacy_header() refuses and for words that are no numbers, and the errors of SpoolFile.
std::unique_ptr<VolumeSource> open_vtk_legacy(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_vtk_legacy(const std::string& path, const SourceOptions& options);

}  // namespace weir
