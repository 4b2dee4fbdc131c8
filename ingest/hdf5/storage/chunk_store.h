// The chunks of an HDF5 dataset as they lie in the file, filters and all.
//
// They are fetched by H5Dread_chunk under the library's lock, not by reads of our
// own at the chunks' addresses: libhdf5 1.10 gives addresses only by a walk
// through the whole index for each chunk, a chunk may move while a simulation
// writes (SWMR), and a file may be several (drivers family, split). The lock is
// held for a copy out of the page cache or one device read; decoding takes ten
// times as long, and that is done outside.
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
  bool partial_unfiltered = false;  ///< chunks that overhang the extent have gone through no filter

  /// Whether the chunk whose first element is `corner` overhangs the extent.
  bool is_partial(std::span<const hsize_t> corner) const;
};

/// "0, 64, 128": a chunk's first element, in the file's order of axes.
std::string corner_text(std::span<const hsize_t> corner);

/// Bytes of the chunk of a dataset whose first element is `corner`, as stored; 0 where the file holds none. Messages
/// begin with `name`. The caller holds Hdf5Lock. Throws Error(input).
hsize_t stored_chunk_bytes(hid_t dataset, std::span<const hsize_t> corner, const std::string& name);

/// Thread-safe; takes Hdf5Lock itself.
class ChunkStore {
 public:
  /// `dataset` is open, chunked and outlives the store; messages begin with `name`. Throws Error(input)
  /// where the library cannot say how it is cut, and where chunks without filters have other lengths than all have.
  ChunkStore(hid_t dataset, std::string name);

  const std::string& name() const { return name_; }
  const ChunkLayout& layout() const { return layout_; }
  /// Only for a dataset that own_pipeline takes.
  const FilterPipeline& pipeline() const { return pipeline_; }

  struct Chunk {
    std::size_t bytes = 0;  ///< as stored
    FilterMask left_out = 0;
  };
  /// Fetches the chunk whose first element is `corner` to the front of `into`; nullopt where the file holds
  /// none. Throws Error(input) where it is larger than `into` or cannot be read.
  std::optional<Chunk> fetch(std::span<const hsize_t> corner, std::span<std::byte> into) const;

 private:
  hid_t dataset_;
  std::string name_;
  std::string crash_line_;
  ChunkLayout layout_;
  FilterPipeline pipeline_;
};

}  // namespace weir
