// NRRD volumes: .nrrd files have the values after the header, .nhdr files have them in a separate file.
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

/// Endings of NRRD file names, in lower case.
inline constexpr std::array<std::string_view, 2> kNrrdEndings{".nrrd", ".nhdr"};

/// Recognises a file by its magic, whatever its name, or by its name alone (kNrrdEndings).
bool recognises_nrrd(std::string_view path, std::span<const std::byte> head);

/// Opens the volume. A first axis of one value, on which NRRD keeps channels, is dropped. --index chooses along the
/// axes after the next three. Space directions, or otherwise spacings and ranges of the axes, become spacing and
/// origin with place_axes. Throws Error(input) for what parse_nrrd_header refuses and for vectors, colours and times
/// among the axes that would be x, y and z. Also throws the errors of open_header_volume.
std::unique_ptr<VolumeSource> open_nrrd(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_nrrd(const std::string& path, const SourceOptions& options);

}  // namespace weir
