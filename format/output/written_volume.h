// The volume of a conversion that is written, but has no name of its own yet, as a reader sees it.
#pragma once

#include <optional>

#include "format/io/file_system.h"
#include "format/nanovdb/nvdb_file.h"
#include "format/nanovdb/nvdb_grid.h"

namespace weir {

class WrittenVolume {
 public:
  /// Maps `file`, which is complete and must not be written to while this object is used: by its descriptor, whatever
  /// has its path, and by its path where it has none. Uses its bytes where they are where it lies in memory. Throws
  /// Error(io) where it cannot be read back.
  explicit WrittenVolume(const File& file);

  const NvdbGrid& grid() const { return mapped_ ? mapped_->grid() : *held_; }
  /// See FileMapping::release_pages; nothing where the file lies in memory.
  void release_pages() const;

 private:
  std::optional<NvdbFile> mapped_;
  std::optional<NvdbGrid> held_;
};

}  // namespace weir
