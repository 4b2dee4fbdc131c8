// MetaImage volumes: .mha files have the values after the header, .mhd files have them in a separate file.
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

/// Endings of MetaImage file names, in lower case.
inline constexpr std::array<std::string_view, 2> kMetaImageEndings{".mhd", ".mha"};

/// Recognises a file by its name (kMetaImageEndings), because the text has no magic.
bool recognises_meta_image(std::string_view path, std::span<const std::byte> head);

/// Opens the volume. --index chooses along the axes after the third. Spacing, offset and transform become spacing and
/// origin with place_axes. Throws Error(input) for what parse_meta_image_header refuses, and the errors of
/// open_header_volume.
std::unique_ptr<VolumeSource> open_meta_image(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_meta_image(const std::string& path, const SourceOptions& options);

}  // namespace weir
