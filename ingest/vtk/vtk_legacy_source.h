// Legacy VTK structured points, .vtk.
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
inline constexpr std::array<std::string_view, 1> kVtkLegacyEndings{".vtk"};

/// By its first line or the name.
bool recognises_vtk_legacy(std::string_view path, std::span<const std::byte> head);

/// The array options.dataset of the points or the cells, or the only one that can be converted, ghost types and the
/// like aside. Binary values are read where they lie, text is decoded here, once, into a spool file. Throws
/// Error(usage) where several can be converted and none is named; Error(input) for what parse_vtk_legacy_header refuses
/// and words that are no numbers; what SpoolFile throws.
std::unique_ptr<VolumeSource> open_vtk_legacy(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_vtk_legacy(const std::string& path, const SourceOptions& options);

}  // namespace weir
