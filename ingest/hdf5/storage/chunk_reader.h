// Reads boxes of a chunked HDF5 dataset and decodes its chunks in parallel. The library runs its filters under one
// global lock. Here only the fetch of a stored chunk holds that lock; inflating, unshuffling and converting run on
// TBB's workers (ingest/chunks).
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
#include "ingest/hdf5/storage/chunk_components.h"
#include "ingest/hdf5/storage/chunk_store.h"
#include "ingest/source/component_choice.h"
#include "ingest/source/stored_value.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// A three-dimensional slice of a chunked dataset, at one position on the leading axes. The slice has the dataset's
/// last three axes, or the three axes before the last if the last axis holds the components of each voxel.
struct ChunkedSlice {
  hid_t dataset = H5I_INVALID_HID;        ///< open, chunked; outlives the reader, which does not close it
  std::string name;                       ///< "PATH: DATASET": messages begin with it
  std::vector<std::int64_t> index;        ///< one position inside each leading axis, slowest first
  ScalarType type = ScalarType::float32;  ///< has the size of the stored type
  bool big_endian = false;
  ValueMapping mapping;
  std::vector<std::byte> fill;      ///< one stored value, read for voxels of chunks that the file does not hold
  VoxelComponents components = {};  ///< if several: along the last axis, some or all in each chunk
  bool all_stored = false;          ///< the file says that it holds every chunk, so a missing chunk is damage
};

/// What reading has done so far.
struct ChunkCounts {
  std::uint64_t decoded = 0;      ///< decoded chunks; a chunk decoded twice counts twice
  std::uint64_t unallocated = 0;  ///< requests for chunks that the file does not hold
  std::uint64_t bytes_read = 0;   ///< stored bytes of the chunks decoded
};

/// Takes the library's lock (Hdf5Lock) itself, in the constructor and in read: callers must not hold it.
/// Thread-safe.
class ChunkReader final : private StoredChunks {
 public:
  /// Returns whether weir itself can undo all filters of a chunked dataset (own_pipeline). The caller holds the lock.
  static bool decodes(hid_t dataset);

  /// Decodes at most as many chunks at a time as ScratchPool allows for `memory` bytes. Throws ScratchPool's errors,
  /// and Error(input) if a chunk has no sensible size. `slice.dataset` satisfies decodes().
  ChunkReader(ChunkedSlice slice, std::uint64_t memory);

  /// Chunk extent in voxels and bytes per voxel, for the block plan; chunks begin at index 0.
  AccessShape access() const { return boxes_.access(); }
  /// Memory for chunks being decoded, in bytes.
  std::uint64_t working_bytes() const { return scratch_.bytes(); }
  ChunkCounts counts() const;

  /// Reads `box` (voxels counted from the slice's first, inside the slice, not empty) into `values`, x fastest.
  /// Decodes every chunk that the box touches and that holds a wanted component once. Throws Error(input), naming
  /// dataset and chunk, if a chunk cannot be fetched, fails its checksum, or decodes to more or fewer bytes than a
  /// chunk has.
  ConversionLoss read(const Box& box, std::span<float> values) { return boxes_.read(box, values); }

 private:
  std::span<const std::byte> decode(const Index3& chunk, ChunkScratch& scratch) override;
  /// Decodes the chunk at `chunk` that holds the components from `component` on. Returns its slice, or an empty span
  /// if the file does not hold the chunk.
  std::span<const std::byte> decode_part(const Index3& chunk, std::int64_t component, ChunkScratch& scratch);
  std::vector<hsize_t> corner_of(const Index3& chunk, std::int64_t component) const;

  ChunkedSlice slice_;
  ChunkStore store_;
  ChunkComponents components_;
  std::size_t chunk_bytes_;  ///< unfiltered, all leading axes
  ScratchPool scratch_;
  ChunkBoxes boxes_;
  std::size_t first_byte_;  ///< of the slice inside a chunk

  std::atomic<std::uint64_t> decoded_{0};
  std::atomic<std::uint64_t> unallocated_{0};
  std::atomic<std::uint64_t> bytes_read_{0};
};

}  // namespace weir
