// Sources whose library hands out stored values box by box, one call at a time:
// the way for whatever has no faster one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Where stored values come from. One thread at a time.
class StoredBoxes {
 public:
  virtual ~StoredBoxes() = default;

  /// Fills `stored` with the values of `box` as they are stored, x fastest. Throws Error(input).
  virtual void read(const Box& box, std::span<std::byte> stored) = 0;
  /// The grid that boxes should be cut at, so that no chunk is decoded for two of them: extent (zero where
  /// there is none) and a corner.
  virtual Index3 chunk() const = 0;
  virtual Index3 chunk_origin() const { return {0, 0, 0}; }
  /// Paths of the files that values come from, besides the one that was opened.
  virtual std::vector<std::string> files() const { return {}; }
  /// What it and its library hold besides, in bytes.
  virtual std::uint64_t working_bytes() const = 0;
};

/// A source of `info`, whose domain begins at index 0, with values of info.type. Reads in pieces of whole chunks,
/// through one buffer that takes at most a sixteenth of `memory` bytes or one chunk. Throws Error(usage), naming
/// `where` and a sufficient --memory, where chunks need more than half of it.
std::unique_ptr<VolumeSource> make_stored_box_source(std::unique_ptr<StoredBoxes> boxes, SourceInfo info,
                                                     bool big_endian, std::uint64_t memory, const std::string& where);

}  // namespace weir
