// Boxes of a chunked HDF5 dataset, decoded in parallel. The library runs its
// filters under one global lock; here only the fetching of a stored chunk is
// under it, and inflating, unshuffling and converting run on TBB's workers (ingest/chunks).
#pragma once

#include <hdf5.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "format/base/scalar_type.h"
#include "ingest/chunks/chunk_boxes.h"
#include "ingest/hdf5/storage/chunk_store.h"
#include "ingest/source/component_choice.h"
#include "ingest/source/stored_value.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// A three-dimensional slice of a chunked dataset: its last three axes, at one position on the others; or the three
/// before the last, which has the components of each voxel.
struct ChunkedSlice {
  hid_t dataset = H5I_INVALID_HID;        ///< open, chunked; outlives the reader, which does not close it
  std::string name;                       ///< "PATH: DATASET": messages begin with it
  std::vector<std::int64_t> index;        ///< position on each leading axis, slowest first; one for each, inside
  ScalarType type = ScalarType::float32;  ///< whose size is the stored type's
  bool big_endian = false;
  ValueMapping mapping;
  std::vector<std::byte> fill;      ///< one stored value: what voxels of chunks that the file does not hold read as
  VoxelComponents components = {};  ///< more than one: along the last axis, all of them in each chunk
  bool all_stored = false;          ///< the file says that it holds every chunk: one that is missing is damage

  std::size_t voxel_bytes() const { return scalar_bytes(type) * static_cast<std::size_t>(components.count); }
};

/// What reading has done so far.
struct ChunkCounts {
  std::uint64_t decoded = 0;      ///< chunks, each time one is
  std::uint64_t unallocated = 0;  ///< chunks asked for that the file does not hold, each time
  std::uint64_t bytes_read = 0;   ///< stored bytes of the chunks decoded
};

/// Takes the library's lock (Hdf5Lock) itself, in the constructor and in read: callers must not hold it.
/// Thread-safe.
class ChunkReader final : private StoredChunks {
 public:
  /// Whether all filters of a chunked dataset are ones that are run here (own_pipeline). The caller holds
  /// the lock.
  static bool decodes(hid_t dataset);

  /// Decodes at most as many chunks at a time as ScratchPool allows for `memory` bytes, and throws what it
  /// throws; Error(input) where a chunk has no sensible size. `slice.dataset` satisfies decodes().
  ChunkReader(ChunkedSlice slice, std::uint64_t memory);

  /// Chunk extent in voxels and bytes per voxel, for the block plan; chunks begin at index 0.
  AccessShape access() const { return boxes_.access(); }
  /// Memory for chunks being decoded, in bytes.
  std::uint64_t working_bytes() const { return scratch_.bytes(); }
  ChunkCounts counts() const;

  /// Reads `box` (voxels from the slice's first, inside it, not empty) into `values`, x fastest. Every
  /// chunk it touches is decoded once. Throws Error(input), naming dataset and chunk, where a chunk cannot
  /// be fetched, fails its checksum, or decodes to more or fewer bytes than a chunk has.
  ConversionLoss read(const Box& box, std::span<float> values) { return boxes_.read(box, values); }

 private:
  std::span<const std::byte> decode(const Index3& chunk, ChunkScratch& scratch) override;
  std::vector<hsize_t> corner_of(const Index3& chunk) const;

  ChunkedSlice slice_;
  ChunkStore store_;
  std::size_t chunk_bytes_;  ///< unfiltered, all leading axes
  ScratchPool scratch_;
  ChunkBoxes boxes_;
  std::size_t first_byte_;  ///< of the slice inside a chunk

  std::atomic<std::uint64_t> decoded_{0};
  std::atomic<std::uint64_t> unallocated_{0};
  std::atomic<std::uint64_t> bytes_read_{0};
};

}  // namespace weir
