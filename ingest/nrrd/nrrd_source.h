// NRRD volumes: .nrrd with the values after the header, .nhdr with them in a file
// of their own.
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
inline constexpr std::array<std::string_view, 2> kNrrdEndings{".nrrd", ".nhdr"};

/// By its magic, whatever the name; and what only looks so, by a name (kNrrdEndings).
bool recognises_nrrd(std::string_view path, std::span<const std::byte> head);

/// A first axis of one value (NRRD keeps channels there) is dropped, --index chooses along the axes after the next
/// three. Space directions, or else spacings and ranges of the axes, become spacing and origin as place_axes does it.
/// Throws Error(input) for what parse_nrrd_header refuses, for vectors, colours and times among the axes that would be
/// x, y and z, and what open_header_volume throws.
std::unique_ptr<VolumeSource> open_nrrd(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_nrrd(const std::string& path, const SourceOptions& options);

}  // namespace weir
