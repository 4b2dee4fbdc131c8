// NIfTI volumes: .nii and .nii.gz with the values after the header, .hdr with
// them in the .img beside it.
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

/// Of the names of its files, in lower case; those of a header beside its values say nothing of the format.
inline constexpr std::array<std::string_view, 2> kNiftiEndings{".nii", ".nii.gz"};

/// By the name: kNiftiEndings, or .hdr where the file also begins as NIfTI does. The magic lies further in.
bool recognises_nifti(std::string_view path, std::span<const std::byte> head);

/// NIfTI-1 and NIfTI-2. --index chooses along the axes after the third, of which the fourth may be a time; the sform,
/// else the qform, else pixdim becomes spacing and origin as place_axes does it: the first that the header has and that
/// is a place. details.values_note says which it has and is none. Throws Error(input) for what parse_nifti_header
/// refuses, and what open_header_volume throws.
std::unique_ptr<VolumeSource> open_nifti(const std::string& path, const SourceOptions& options);
std::vector<DatasetInfo> list_nifti(const std::string& path, const SourceOptions& options);

}  // namespace weir
