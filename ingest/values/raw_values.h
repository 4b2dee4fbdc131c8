// A source for a dense array in a file: uncompressed values in file order, x fastest. Raw files are such arrays, and
// most header formats describe them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "format/base/scalar_type.h"
#include "ingest/files/input_file.h"
#include "ingest/source/component_choice.h"
#include "ingest/source/stored_value.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// How the values lie in the file.
struct RawLayout {
  std::uint64_t offset = 0;  ///< bytes before the first value
  ScalarType type = ScalarType::float32;
  bool big_endian = false;
  ValueMapping mapping;
  VoxelComponents components = {};  ///< components of each voxel, side by side

  std::size_t voxel_bytes() const { return scalar_bytes(type) * static_cast<std::size_t>(components.count); }
};

/// Returns a source of `info` that reads its values from `file` by `layout`. Fills info.type, mapping, file_bytes,
/// mtime_ns and files if they are zero or empty. The extent's bytes must fit the file: otherwise throws
/// Error(internal), because the caller reports this with a better message. Needs up to kStagingBytes
/// (ingest/plan/staging.h) besides the callers' buffers.
std::unique_ptr<VolumeSource> make_raw_values(std::unique_ptr<InputFile> file, const RawLayout& layout,
                                              SourceInfo info);

}  // namespace weir
