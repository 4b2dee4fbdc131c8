// MetaImage volumes: .mha with the values after the header, .mhd with them in a
// file of their own.
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
inline constexpr std::array<std::string_view, 2> kMetaImageEndings{".mhd", ".mha"};

/// By the name, kMetaImageEndings: the text has no magic.
bool recognises_meta_image(std::string_view path, std::span<const std::byte> head);

/// --index chooses along the axes after the third; spacing, offset and transform become spacing and origin as
/// place_axes does it. Throws Error(input) for what parse_meta_image_header refuses, and what open_header_volume
/// throws.
std::unique_ptr<VolumeSource> open_meta_image(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_meta_image(const std::string& path, const SourceOptions& options);

}  // namespace weir
