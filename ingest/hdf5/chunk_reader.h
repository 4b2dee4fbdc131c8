// Boxes of a chunked HDF5 dataset, decoded in parallel. The library runs its
// filters under one global lock; here only the fetching of a stored chunk is
// under it, and inflating, unshuffling and converting run on TBB's workers.
#pragma once

#include <hdf5.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "format/index.h"
#include "format/scalar_type.h"
#include "ingest/stored_value.h"
#include "ingest/volume_source.h"

namespace weir {

/// A three-dimensional slice of a chunked dataset: its last three axes, at one position on the others.
struct ChunkedSlice {
  hid_t dataset = H5I_INVALID_HID;        ///< open, chunked, of rank >= 3; outlives the reader, which does not close it
  std::string name;                       ///< "PATH: DATASET": messages begin with it
  std::vector<std::int64_t> index;        ///< position on each leading axis, slowest first; rank - 3 of them, inside
  ScalarType type = ScalarType::float32;  ///< whose size is the stored type's
  bool big_endian = false;
  ValueMapping mapping;
  std::vector<std::byte> fill;  ///< one stored value: what voxels of chunks that were never written read as
};

/// What reading has done so far.
struct ChunkCounts {
  std::uint64_t decoded = 0;         ///< chunks, each time one is
  std::uint64_t unallocated = 0;     ///< chunks asked for that the file does not hold, each time
  std::uint64_t bytes_read = 0;      ///< stored bytes of the chunks decoded
  std::size_t decoding_threads = 0;  ///< different threads that decoded
};

/// Takes the library's lock (Hdf5Lock) itself, in every member and in the constructor: callers must not
/// hold it. Thread-safe.
class ChunkReader {
 public:
  /// Whether all filters of a chunked dataset are ones that are run here: deflate, shuffle, fletcher32, in
  /// any order and number, or none. The caller holds the lock.
  static bool decodes(hid_t dataset);

  /// Decodes at most as many chunks at a time as fit half of `memory` bytes. Throws Error(usage) naming a
  /// sufficient --memory where not even one does. `slice.dataset` satisfies decodes().
  ChunkReader(ChunkedSlice slice, std::uint64_t memory);
  ~ChunkReader();

  /// Chunk extent in voxels and bytes per voxel, for the block plan; chunks begin at index 0.
  AccessShape access() const;
  /// Memory for chunks being decoded, in bytes.
  std::uint64_t working_bytes() const;
  ChunkCounts counts() const;

  /// Reads `box` (voxels from the slice's first, inside it, not empty) into `values`, x fastest. Every
  /// chunk it touches is decoded once. Throws Error(input), naming dataset and chunk, where a chunk cannot
  /// be fetched, fails its checksum, or decodes to more or fewer bytes than a chunk has.
  ConversionLoss read(const Box& box, std::span<float> values);

 private:
  class Decoder;
  std::unique_ptr<Decoder> decoder_;
};

}  // namespace weir
