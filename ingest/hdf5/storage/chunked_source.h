// A source of chunks that weir decodes itself.
#pragma once

#include <cstdint>
#include <memory>

#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/storage/chunk_reader.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Returns a source of `info` with the values of `slice`, a slice of `dataset`. Throws the errors of ChunkReader.
std::unique_ptr<VolumeSource> make_chunked_source(Hdf5Handle dataset, ChunkedSlice slice, SourceInfo info,
                                                  std::uint64_t memory);

}  // namespace weir
