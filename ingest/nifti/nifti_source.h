// NIfTI volumes: .nii and .nii.gz files have the values after the header, .hdr files have them in the .img beside it.
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

/// Endings of NIfTI file names, in lower case. The endings of a header beside its values are not among them, because
/// other formats use them too.
inline constexpr std::array<std::string_view, 2> kNiftiEndings{".nii", ".nii.gz"};

/// Recognises a file by its name: kNiftiEndings, or .hdr if the file also begins like NIfTI. The magic lies further
/// in.
bool recognises_nifti(std::string_view path, std::span<const std::byte> head);

/// Opens a NIfTI-1 or NIfTI-2 volume. --index chooses along the axes after the third; the fourth may be a time. The
/// first usable of sform, qform and pixdim becomes spacing and origin with place_axes. details.values_note names a
/// form that the header has but that is not usable. Throws Error(input) for what parse_nifti_header refuses, and the
/// errors of open_header_volume.
std::unique_ptr<VolumeSource> open_nifti(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_nifti(const std::string& path, const SourceOptions& options);

}  // namespace weir
