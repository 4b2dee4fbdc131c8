// Boxes of a chunked HDF5 dataset, decoded in parallel. The library runs its
// filters under one global lock; here only the fetching of a stored chunk is
// under it, and inflating, unshuffling and converting run on TBB's workers.
#pragma once

#include <hdf5.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "format/base/index.h"
#include "format/base/scalar_type.h"
#include "ingest/hdf5/storage/chunk_scratch.h"
#include "ingest/hdf5/storage/chunk_store.h"
#include "ingest/source/stored_value.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// A three-dimensional slice of a chunked dataset: its last three axes, at one position on the others.
struct ChunkedSlice {
  hid_t dataset = H5I_INVALID_HID;        ///< open, chunked, of rank >= 3; outlives the reader, which does not close it
  std::string name;                       ///< "PATH: DATASET": messages begin with it
  std::vector<std::int64_t> index;        ///< position on each leading axis, slowest first; rank - 3 of them, inside
  ScalarType type = ScalarType::float32;  ///< whose size is the stored type's
  bool big_endian = false;
  ValueMapping mapping;
  std::vector<std::byte> fill;  ///< one stored value: what voxels of chunks that the file does not hold read as
};

/// What reading has done so far.
struct ChunkCounts {
  std::uint64_t decoded = 0;         ///< chunks, each time one is
  std::uint64_t unallocated = 0;     ///< chunks asked for that the file does not hold, each time
  std::uint64_t bytes_read = 0;      ///< stored bytes of the chunks decoded
  std::size_t decoding_threads = 0;  ///< different threads that decoded
};

/// Takes the library's lock (Hdf5Lock) itself, in the constructor and in read: callers must not hold it.
/// Thread-safe.
class ChunkReader {
 public:
  /// Whether all filters of a chunked dataset are ones that are run here (own_pipeline). The caller holds
  /// the lock.
  static bool decodes(hid_t dataset);

  /// Decodes at most as many chunks at a time as ScratchPool allows for `memory` bytes, and throws what it
  /// throws; Error(input) where a chunk has no sensible size. `slice.dataset` satisfies decodes().
  ChunkReader(ChunkedSlice slice, std::uint64_t memory);

  /// Chunk extent in voxels and bytes per voxel, for the block plan; chunks begin at index 0.
  AccessShape access() const;
  /// Memory for chunks being decoded, in bytes.
  std::uint64_t working_bytes() const { return scratch_.bytes(); }
  ChunkCounts counts() const;

  /// Reads `box` (voxels from the slice's first, inside it, not empty) into `values`, x fastest. Every
  /// chunk it touches is decoded once. Throws Error(input), naming dataset and chunk, where a chunk cannot
  /// be fetched, fails its checksum, or decodes to more or fewer bytes than a chunk has.
  ConversionLoss read(const Box& box, std::span<float> values);

 private:
  /// The part of `box` that the chunk at `chunk` (chunk coordinates) holds.
  ConversionLoss read_chunk(const Index3& chunk, const Box& box, std::span<float> values, ChunkScratch& scratch);
  /// The chunk's bytes, filters undone, which lie in `scratch`; empty where the file does not hold it.
  std::span<const std::byte> decode(std::span<const hsize_t> corner, ChunkScratch& scratch);
  std::vector<hsize_t> corner_of(const Index3& chunk) const;

  ChunkedSlice slice_;
  ChunkStore store_;
  Index3 chunk_;                 ///< voxels
  std::size_t first_byte_ = 0;   ///< of the slice inside a chunk
  std::size_t chunk_bytes_ = 0;  ///< unfiltered, all leading axes
  float fill_ = 0;
  ConversionLoss fill_loss_;  ///< of one voxel
  ScratchPool scratch_;

  std::atomic<std::uint64_t> decoded_{0};
  std::atomic<std::uint64_t> unallocated_{0};
  std::atomic<std::uint64_t> bytes_read_{0};
  mutable std::mutex mutex_;
  std::set<std::thread::id> threads_;
};

}  // namespace weir
