// Raw volumes: values in file order, x fastest, after an optional header.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "format/index.h"
#include "format/scalar_type.h"
#include "ingest/input_file.h"
#include "ingest/volume_source.h"

namespace weir {

/// What the user says about a raw file. What the name says too (ingest/raw_name.h) must agree.
struct RawOptions {
  std::optional<Index3> extent;                  ///< --dims, voxels; from the name where absent
  std::optional<ScalarType> type;                ///< --type; from the name where absent
  std::optional<bool> big_endian;                ///< --endian; from the name where absent, else little
  std::uint64_t offset = 0;                      ///< --offset: bytes before the first value
  std::optional<std::array<double, 3>> spacing;  ///< --spacing: world units per voxel, > 0; default 1
  std::optional<std::array<double, 3>> origin;   ///< --origin: world position of index (0, 0, 0); default 0
  DirectIo direct_io = DirectIo::automatic;      ///< --direct-io
};

/// Opens `path` and checks its size against the extent; no value is read yet. The source needs up to
/// kStagingBytes (ingest/staging.h) besides the caller's buffers.
/// Throws Error(usage) where an option contradicts the name or the extent or type is neither given
/// nor named, or spacing or origin are no usable numbers; Error(input) where the file is missing, a
/// directory, unreadable or empty, the extent is impossible, or the size does not match it.
std::unique_ptr<VolumeSource> open_raw(const std::string& path, const RawOptions& options);

}  // namespace weir
