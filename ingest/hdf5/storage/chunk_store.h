// Fetches the chunks of an HDF5 dataset as the file stores them, with all filters still applied.
// ChunkStore uses H5Dread_chunk under the library's lock. It does not read at the chunks' addresses itself, for three
// reasons: libhdf5 1.10 walks the whole index for each chunk's address, a chunk may move while a simulation writes
// (SWMR), and a file may consist of several (drivers family, split). The lock is held for a copy out of the page
// cache or for one device read. Decoding takes ten times as long and runs without the lock.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ingest/hdf5/filters/filter_pipeline.h"

namespace weir {

/// How a dataset is cut into chunks. Axes in the file's order, slowest first.
struct ChunkLayout {
  std::vector<hsize_t> extent;      ///< of the dataset, elements
  std::vector<hsize_t> chunk;       ///< elements
  bool partial_unfiltered = false;  ///< chunks that overhang the extent are stored without filters

  /// Returns whether the chunk with the first element `corner` overhangs the extent.
  bool is_partial(std::span<const hsize_t> corner) const;
};

/// Returns a chunk's first element as text, in the file's order of axes: "0, 64, 128".
std::string corner_text(std::span<const hsize_t> corner);

/// Returns the stored bytes of the dataset's chunk with the first element `corner`; 0 if the file does not hold the
/// chunk. Messages begin with `name`. The caller holds Hdf5Lock. Throws Error(input).
hsize_t stored_chunk_bytes(hid_t dataset, std::span<const hsize_t> corner, const std::string& name);

/// Thread-safe; takes Hdf5Lock itself.
class ChunkStore {
 public:
  /// `dataset` is open and chunked, and outlives the store. Messages begin with `name`. Throws Error(input) if the
  /// library cannot say how the dataset is chunked, or if unfiltered chunks do not have the bytes of a full chunk.
  ChunkStore(hid_t dataset, std::string name);

  const std::string& name() const { return name_; }
  const ChunkLayout& layout() const { return layout_; }
  /// The filters of the dataset. Call only for a dataset that own_pipeline() accepts.
  const FilterPipeline& pipeline() const { return pipeline_; }

  struct Chunk {
    std::size_t bytes = 0;  ///< as stored
    FilterMask left_out = 0;
  };
  /// Fetches the chunk with the first element `corner` to the front of `into`; returns nullopt if the file does not
  /// hold it. Throws Error(input) if the chunk is larger than `into` or cannot be read.
  std::optional<Chunk> fetch(std::span<const hsize_t> corner, std::span<std::byte> into) const;

 private:
  hid_t dataset_;
  std::string name_;
  std::string crash_line_;
  ChunkLayout layout_;
  FilterPipeline pipeline_;
};

}  // namespace weir
